// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/image/image_reader.h"
#include "tools/sequence/sequence_channels.h"

namespace quincunx::tools {
namespace {

Status check_size(const std::string& path, Extent found, Extent wanted) {
  if (found == wanted) return {};
  return Status::io(fmt::format("truth '{}' is {}x{} pixels; the output is {}x{}", path, found.width,
                                found.height, wanted.width, wanted.height));
}

Result<std::vector<float>> read_truth(const std::string& path, const std::string& layer, Extent extent) {
  auto reader = ImageReader::open(path);
  if (!reader.ok()) return reader.status();
  ChannelNames names;
  names.colour = colour_channels_in(reader->header(), layer);
  const auto places = find_channels(path, reader->header(), names, "--truth-colour");
  if (!places.ok()) return Status::io("truth " + places.status().message());
  if (Status status = check_size(path, places->display.extent, extent); !status.ok()) return status;
  std::vector<float> rgba(static_cast<std::size_t>(extent.area()) * 4);
  std::vector<ChannelTarget> targets;
  for (std::size_t c = 0; c < 3; ++c) {
    targets.push_back({*places->colour[c], ChannelType::kFloat, rgba.data() + c, 4 * sizeof(float),
                       4 * sizeof(float) * static_cast<std::size_t>(extent.width)});
  }
  if (Status status = reader->read(targets); !status.ok()) return status;
  return rgba;
}

}  // namespace

Result<std::unique_ptr<SequenceScores>> SequenceScores::create(const TruthFiles& truth, Extent extent,
                                                               std::span<const std::int64_t> frames,
                                                               bool keep_pictures) {
  if (Status status = ScoredFrames::check(extent, "--truth"); !status.ok()) return status;
  auto scores = std::unique_ptr<SequenceScores>(new SequenceScores(truth, extent));
  for (const std::int64_t frame : frames) {
    std::error_code error;
    const std::string path = truth.pattern.expand(frame);
    if (!std::filesystem::exists(path, error)) continue;
    scores->known_.push_back(frame);
    scores->files_.push_back(path);
  }
  scores->scored_.emplace(scores->known_, keep_pictures);
  if (!scores->known_.empty()) return scores;
  return Status::io(
      fmt::format("no file of truth pattern '{}' belongs to a frame of this run", truth.pattern.text()));
}

Status SequenceScores::add(std::int64_t frame, SharedPixels pixels, const MotionField& motion) {
  if (!std::binary_search(known_.begin(), known_.end(), frame)) return {};
  std::vector<Vec2> velocity;
  if (scored_->keeps(frame)) velocity.assign(motion.velocity.begin(), motion.velocity.end());
  return queue_.push(
      [this, frame, pixels = std::move(pixels), extent = motion.extent, velocity = std::move(velocity)] {
        return measure_frame(frame, *pixels, {extent, velocity});
      });
}

Status SequenceScores::finish() {
  return queue_.finish();
}

Status SequenceScores::measure_frame(std::int64_t frame, const std::vector<float>& pixels,
                                     const MotionField& motion) {
  const auto truth = read_truth(truth_.pattern.expand(frame), truth_.colour_layer, extent_);
  if (!truth.ok()) return truth.status();
  return scored_->add(frame, {extent_, pixels}, {extent_, truth.value()}, motion);
}

}  // namespace quincunx::tools
