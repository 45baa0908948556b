// SPDX-License-Identifier: BSD-3-Clause
#include "ProgramMain.h"

#include <glog/logging.h>

#include <algorithm>
#include <csignal>
#include <new>
#include <ostream>
#include <system_error>

#include "StopSignals.h"

namespace lintel {

std::string oneLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  // names and damaged text of recordings must not speak to the terminal
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

int programMain(const std::string& name, std::ostream& err, const std::function<int()>& body) {
  std::signal(SIGXFSZ, SIG_IGN);           // a file over the user's limit is an error of writing, not a sudden end
  std::signal(SIGPIPE, SIG_IGN);           // Ctrl-C ends `| tee` first: the results are written all the same
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres' log is no word to a user: what it means for the result is said
  try {
    return body();
  } catch (const Stopped& stopped) {
    err << name << ": " << stopped.what() << "\n";
    return stopped.exitCode();
  } catch (const UsageError& error) {
    err << name << ": " << oneLine(error.what()) << "; see " << name << " --help\n";
    return 2;
  } catch (const std::bad_alloc&) {
    err << name << ": out of memory; free some, or give a shorter part of the recording\n";
  } catch (const std::system_error& error) {
    err << name << ": " << oneLine(error.what());
    if (error.code() == std::errc::resource_unavailable_try_again) err << ": a thread was refused; free some memory";
    err << "\n";
  } catch (const std::exception& error) {
    err << name << ": " << oneLine(error.what()) << "\n";
  }
  return 1;
}

}  // namespace lintel
