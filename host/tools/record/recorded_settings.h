// SPDX-License-Identifier: MIT
// Recorded settings: sequence.json of a recording, with all that its plan was made of.
#pragma once

#include <string>
#include <vector>

#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"

namespace quincunx::tools {

struct RecordedSettings {
  std::string device = {};  // that made the pictures: "platform name"
  SceneNeeds needs = {};
  ResolveSettings settings = {};

  friend bool operator==(const RecordedSettings&, const RecordedSettings&) = default;
};

inline constexpr const char* kSettingsFile = "sequence.json";

std::string to_json(const RecordedSettings& recorded);

// Returns the text of both on one line.
std::string to_line(const RecordedSettings& recorded);

// Returns what differs, a sentence's part each: "method is bilinear in place of temporal".
std::vector<std::string> differences(const ResolveSettings& now, const ResolveSettings& recorded);

// Whether a folder holds a recording: a sequence.json that says so.
bool is_recording(const std::string& folder);

// Fields that the file lacks have their defaults. Errors: kIoFailure, naming the file and the field.
Result<RecordedSettings> read_settings(const std::string& folder);

}  // namespace quincunx::tools
