// SPDX-License-Identifier: MIT
#include "tools/diagnose/diagnose.h"

#include <algorithm>

#include "tools/diagnose/findings.h"

namespace quincunx::tools {
namespace {

using Frames = std::span<const DiagnosedFrame>;

bool has_fault(const Finding& finding, const std::string& fault) {
  return std::find(finding.faults.begin(), finding.faults.end(), fault) != finding.faults.end();
}

// `cuts`: frames before which cuts are missing; that finding is the last.
Diagnosis examine(Frames frames, const DiagnosedInput& input, const std::vector<Plane>& planes,
                  const std::vector<Pair>& pairs, std::vector<std::int64_t>& cuts) {
  const MotionAnswer motion = find_motion(frames, input, planes, pairs);
  const Scene scene = {frames, input, planes, pairs, motion, light_scale(frames)};
  Diagnosis diagnosis = {motion.findings, motion.mend};
  const DepthGuess depth = find_depth(scene, diagnosis.findings);
  if (!has_fault(motion.findings.front(), "frame"))  // which lies beside its surfaces
    diagnosis.findings.push_back(find_dilation(scene, depth.kind));
  diagnosis.findings.push_back(find_resolution(scene));
  diagnosis.findings.push_back(find_sky(scene, depth));
  diagnosis.findings.push_back(find_objects(scene, depth));
  diagnosis.findings.push_back(find_encoding(scene));
  diagnosis.findings.push_back(find_filter(scene, depth.kind));
  find_light(scene, diagnosis.findings, cuts);
  return diagnosis;
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kRight:
      return "right";
    case Verdict::kWrong:
      return "wrong";
    case Verdict::kUnknown:
      return "cannot tell";
  }
  return "";
}

Vec2 JitterMend::of(Vec2 told) const {
  return swapped ? Vec2{told.y * factors.x, told.x * factors.y}
                 : Vec2{told.x * factors.x, told.y * factors.y};
}

bool Diagnosis::wrong() const {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.verdict == Verdict::kWrong; });
}

Diagnosis diagnose(Frames frames, const DiagnosedInput& input) {
  if (frames.empty()) return {};
  const std::vector<Plane> planes = planes_of(frames);
  std::vector<Pair> pairs = pairs_of(frames, planes);
  std::vector<std::int64_t> cuts;
  Diagnosis diagnosis = examine(frames, input, planes, pairs, cuts);
  if (cuts.empty()) return diagnosis;
  // Once more without what is no pair; that there are cuts remains.
  const Finding found = diagnosis.findings.back();
  std::erase_if(pairs, [&](const Pair& pair) {
    return std::find(cuts.begin(), cuts.end(), frames[pair.now].number) != cuts.end();
  });
  diagnosis = examine(frames, input, planes, pairs, cuts);
  diagnosis.findings.back() = found;
  return diagnosis;
}

}  // namespace quincunx::tools