// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace lintel {

/// Contents of a JSON file; null where it is missing or damaged.
nlohmann::ordered_json readJson(const std::filesystem::path& path);

}  // namespace lintel
