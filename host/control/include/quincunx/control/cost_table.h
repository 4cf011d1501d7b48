// SPDX-License-Identifier: MIT
// CostTable: measured frame times by resolution, each with a confidence that decays as it ages.
//
// It is recorded at test points (each resolution in turn, the scene held still) or while a program runs, and
// kept as JSON text. A controller takes from it its first guess of what does not scale with the pixels. It is
// a value without clock or device; not thread safe. Source: "Dynamic Resolution Scaling Implementation Best
// Practice", section 3: weight past times with a confidence value by how long it is since that resolution was
// chosen, and use the inverse to extrapolate from those chosen recently.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/advanced/export.h"
#include "quincunx/status.h"

namespace quincunx {

class QUINCUNX_API CostTable {
 public:
  static constexpr double kMaxArea = 4;    // scale 2 on both axes
  static constexpr int kBinsPerArea = 64;  // resolutions of one 64th of the output's area count as the same

  // Creates an empty table. An entry's confidence halves in half_life_frames. Errors: kInvalidArgument for one outside
  // [1, 1e9].
  static Result<CostTable> create(double half_life_frames = 3600);

  // Records that a frame of this area fraction (in (0, 4]) took `gpu_ms` (in (0, 60000]). Frame numbers may repeat but
  // not fall. Errors: kInvalidArgument, which leaves the table as it was.
  Status record(std::uint64_t frame, double area_fraction, double gpu_ms);

  // Returns the confidence in [0, 1]: 1 right after a resolution was recorded, 0 where it never was.
  double confidence(double area_fraction) const;

  // Predicts the time in ms: a mean of the time that was recorded there, weighted by its confidence, and of the times
  // that the other entries extrapolate to (60000 at most), by their own confidence, if fixed_part of the cost does not
  // scale. Nothing while the table is empty or for an area fraction outside (0, 4].
  std::optional<double> predict(double area_fraction, double fixed_part = 0.25) const;

  // Returns the part of the cost at the output resolution that does not scale, within [0, 0.9], from a straight line
  // through the entries; nothing until they span a quarter of the output's area.
  std::optional<double> fixed_part() const;

  bool empty() const { return entries_.empty(); }

  // Convert to JSON text and back. Ages are kept, so an old table counts less. Errors of from_json(): kInvalidArgument
  // for text that to_json() does not write; the message says what is wrong.
  std::string to_json() const;
  static Result<CostTable> from_json(const std::string& text);

 private:
  struct Entry {
    int bin = 0;
    double area = 0;    // mean of what was recorded
    double gpu_ms = 0;  // the same
    double weight = 0;  // confidence of what `area` and `gpu_ms` average, when last recorded
    double age = 0;     // frames since then
  };
  explicit CostTable(double half_life_frames) : half_life_frames_(half_life_frames) {}
  double decay(double frames) const;
  const Entry* find(int bin) const;

  double half_life_frames_;
  std::uint64_t frame_ = 0;
  bool started_ = false;
  std::vector<Entry> entries_;  // sorted by bin
};

}  // namespace quincunx
