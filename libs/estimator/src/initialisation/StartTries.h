// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace lintel {

/// With which frames a start is tried: while the buffer grows, when it is longer by a tenth than in the last try; once
/// it is full, with every fifth, of which little is new. Of a motion that has not shown the scale for long they show
/// even less, and a try with a full buffer takes up to seconds: tries are as far apart as a tenth of the wait then.
class StartTries {
 public:
  /// Counts a frame; whether a start is to be tried with it.
  bool due();

  /// A try with so many frames, fewer than the buffer may have, was given up.
  void failedWhileGrowing(std::size_t frames, const std::string& reason);

  /// A try with a full buffer was given up, for what initialise() (Initializer.h) says.
  void failed(const std::string& reason);

  /// A start was wrong: it is tried again when there are frames that show more than it was made of.
  void startWasWrong();

  void reset() { *this = {}; }

  const std::string& reason() const { return reason_; }  ///< of waiting
  bool forScale() const { return for_scale_; }           ///< all that the last try lacked

  /// Full buffers have been given up for a while, and not for the scale: fewer frames may do.
  bool mayBeShorter() const;

 private:
  int frames_to_wait_ = 0, waited_for_scale_ = 0, in_vain_ = 0;
  bool for_scale_ = false;
  std::string reason_;
};

}  // namespace lintel
