// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace mrpt::obs {
class CObservation;
}

namespace lintel::test {

using ObservationPtr = std::shared_ptr<mrpt::obs::CObservation>;

std::vector<ObservationPtr> readObservations(const std::string& rawlog);
/// gzip-compressed, by MRPT itself.
void writeObservations(const std::string& rawlog, const std::vector<ObservationPtr>& observations);
/// Rewrites a rawlog with what `change` makes of its observations.
void edit(const std::string& rawlog, const std::function<void(std::vector<ObservationPtr>&)>& change);

}  // namespace lintel::test
