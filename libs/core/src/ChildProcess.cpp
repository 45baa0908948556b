// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/ChildProcess.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <thread>

extern char** environ;

namespace lintel {

namespace {

[[noreturn]] void failWith(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno) + "; free what the system has run out of");
}

/// A file without a name. Unlike a pipe it needs no concurrent reader.
class ScratchFile {
 public:
  ScratchFile() : file_(std::tmpfile()) {
    if (!file_) failWith("temporary file");
    fcntl(descriptor(), F_SETFD, FD_CLOEXEC);
  }
  ~ScratchFile() { std::fclose(file_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  int descriptor() const { return fileno(file_); }
  void fill(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size() || std::fflush(file_) != 0)
      failWith("temporary file");
    std::rewind(file_);
  }
  std::string content() {
    std::rewind(file_);
    std::string text;
    char buffer[65536];
    for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, file_)) > 0;) text.append(buffer, n);
    return text;
  }

 private:
  std::FILE* file_;
};

std::vector<char*> pointersTo(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> environmentWith(const std::vector<std::string>& added) {
  std::vector<std::string> all = added;  // the first of a name counts
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string name = std::string(*entry).substr(0, std::strcspn(*entry, "=") + 1);
    const bool replaced = std::any_of(added.begin(), added.end(), [&](const auto& a) { return a.rfind(name, 0) == 0; });
    if (!replaced) all.emplace_back(*entry);
  }
  return all;
}

struct Descriptors {
  int input, output, errors;
};

/// Between fork and exec: only calls that are safe while other threads hold locks.
[[noreturn]] void becomeChild(const Descriptors& use, pid_t parent, char* const* command, char* const* environment) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // the parent ended before prctl
  dup2(use.input, STDIN_FILENO);
  dup2(use.output, STDOUT_FILENO);
  dup2(use.errors, STDERR_FILENO);
  execvpe(command[0], command, environment);
  const char* reason = std::strerror(errno);
  for (const char* part : {static_cast<const char*>(command[0]), ": ", reason, "\n"})
    if (write(STDERR_FILENO, part, std::strlen(part)) < 0) break;
  _exit(127);
}

ChildResult waitFor(pid_t child, const std::function<bool()>& stop) {
  int status = 0;
  rusage usage{};
  bool told = false;
  for (pid_t ended = 0; ended != child;) {
    ended = wait4(child, &status, stop ? WNOHANG : 0, &usage);
    if (ended < 0 && errno != EINTR) failWith("waiting for a program");
    if (ended != 0) continue;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (!told && stop()) told = kill(child, SIGTERM) == 0;
  }
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  ChildResult result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  result.peak_memory_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;
  return result;
}

}  // namespace

ChildResult runChild(const ChildRequest& request) {
  if (request.command.empty()) throw std::runtime_error("no program to run");
  std::vector<std::string> command = request.command, environment = environmentWith(request.environment);
  const std::vector<char*> command_pointers = pointersTo(command), environment_pointers = pointersTo(environment);
  ScratchFile input, output, errors;
  input.fill(request.input);
  Descriptors use{input.descriptor(), output.descriptor(), errors.descriptor()};
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> log(nullptr, std::fclose);
  if (!request.log_path.empty()) {
    log.reset(std::fopen(request.log_path.c_str(), "ae"));
    if (!log) failWith(request.log_path);
    use.output = use.errors = fileno(log.get());
  }
  const pid_t parent = getpid(), child = fork();
  if (child < 0) failWith("starting " + request.command.front());
  if (child == 0) becomeChild(use, parent, command_pointers.data(), environment_pointers.data());
  ChildResult result = waitFor(child, request.stop);
  result.output = output.content();
  result.errors = errors.content();
  return result;
}

std::string shellLine(const std::vector<std::string>& words) {
  constexpr const char* kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./:,@%";
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace lintel
