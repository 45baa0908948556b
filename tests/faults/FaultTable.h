// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lintel::test {

/// What a reader made of its input.
struct Outcome {
  std::string text;     ///< "refused", "all frames", "18 of 20 frames", "ends after 7 of 20 frames", "read"
  std::string message;  ///< first line of error or warning, without the folder of the test
  int exitCode() const;
  bool operator==(const Outcome& other) const { return text == other.text && message == other.message; }
};

/// One line of faults.txt: form of the input | kind of fault | edits | exit code | outcome | message.
struct FaultRow {
  std::string form, kind, edits;
  Outcome expected;
};

std::vector<FaultRow> readFaultTable(const std::filesystem::path& file);
std::string faultTableText(const std::vector<FaultRow>& rows);

/// The table of kinds in doc/faults.md: kind, what happens, an example of the message.
std::string kindTable(const std::vector<FaultRow>& rows);

/// Forms of the table that are runs of lintel-map on the maps and the recording that makeMapProgramInputs() leaves:
/// "densify", "merge", "export EXTENSION".
bool isMapProgram(const std::string& form);
void makeMapProgramInputs(const std::filesystem::path& folder);
Outcome runMapProgram(const std::filesystem::path& work, const std::string& form);

/// Inputs of every form, made once; copies of them are damaged and read.
class FaultInputs {
 public:
  /// Makes the inputs below `folder`. Throws std::runtime_error.
  explicit FaultInputs(const std::filesystem::path& folder);

  /// Applies the edits to a copy of the inputs and reads it as lintel's programs do.
  Outcome outcomeOf(const FaultRow& fault) const;

 private:
  void makeRecordings() const;
  void makeOtherFiles() const;
  /// `fewer_listed`: the input itself is one of fewer frames.
  Outcome readRecording(const std::filesystem::path& work, const std::string& name, bool calibrated,
                        bool fewer_listed) const;

  std::filesystem::path folder_;
};

}  // namespace lintel::test
