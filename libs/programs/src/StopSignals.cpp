// SPDX-License-Identifier: BSD-3-Clause
#include "StopSignals.h"

#include <atomic>
#include <cstdint>
#include <ctime>

namespace lintel {

namespace {

constexpr std::int64_t kSameWishNs = 500000000;

// A handler of signals can reach nothing but what is static.
std::atomic<int> noted_signal{0};
std::atomic<std::int64_t> noted_ns{0};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free,
              "to be written by a handler of signals");

std::int64_t nowNs() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);  // one of the calls that a handler may make
  return std::int64_t{now.tv_sec} * 1000000000 + now.tv_nsec;
}

extern "C" void noteSignal(int signal) {
  const std::int64_t now_ns = nowNs();
  std::int64_t first_ns = 0;
  if (noted_ns.compare_exchange_strong(first_ns, now_ns)) {
    noted_signal = signal;
    return;
  }
  if (now_ns - first_ns < kSameWishNs) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

StopSignals::StopSignals() {
  noted_signal = 0;
  noted_ns = 0;
  struct sigaction action {};
  action.sa_handler = noteSignal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
  }
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

bool StopSignals::asked() const { return noted_signal != 0; }

void StopSignals::check() const {
  if (asked()) throw Stopped("stopped by " + name() + ", nothing was written", exitCode());
}

std::string StopSignals::name() const {
  switch (noted_signal) {
    case SIGINT:
      return "SIGINT";
    case SIGTERM:
      return "SIGTERM";
    case SIGHUP:
      return "SIGHUP";
    default:
      return "no signal";
  }
}

int StopSignals::exitCode() const { return 128 + noted_signal; }

}  // namespace lintel
