// SPDX-License-Identifier: BSD-3-Clause
#include "TinyRawlog.h"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/CArchive.h>

namespace lintel::test {

std::vector<ObservationPtr> readObservations(const std::string& rawlog) {
  mrpt::io::CFileGZInputStream file(rawlog);
  auto archive = mrpt::serialization::archiveFrom(file);
  std::vector<ObservationPtr> all;
  try {
    for (;;) all.push_back(std::dynamic_pointer_cast<mrpt::obs::CObservation>(archive.ReadObject()));
  } catch (const mrpt::serialization::CExceptionEOF&) {
  }
  return all;
}

void writeObservations(const std::string& rawlog, const std::vector<ObservationPtr>& observations) {
  mrpt::io::CFileGZOutputStream file(rawlog);
  auto archive = mrpt::serialization::archiveFrom(file);
  for (const ObservationPtr& observation : observations) archive << *observation;
}

void edit(const std::string& rawlog, const std::function<void(std::vector<ObservationPtr>&)>& change) {
  std::vector<ObservationPtr> observations = readObservations(rawlog);
  change(observations);
  writeObservations(rawlog, observations);
}

}  // namespace lintel::test
