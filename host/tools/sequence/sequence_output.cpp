// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_output.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "tools/image/display_light.h"
#include "tools/image/image_reader.h"
#include "tools/program/atomic_file.h"
#include "tools/record/exchange_attributes.h"
#include "tools/sequence/sequence_channels.h"

namespace quincunx::tools {
namespace {

constexpr const char* kSettingsAttribute = "quincunx:resolve";

// The folder with its final slash, "" for the current one.
std::string folder_of(const std::string& path) {
  return path.substr(0, path.rfind('/') + 1);
}

// The same file, whatever its names.
using FileIdentity = std::pair<dev_t, ino_t>;
bool identify(const std::string& path, FileIdentity& identity) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0) return false;
  identity = {status.st_dev, status.st_ino};
  return true;
}

Status check_size(const std::string& path, Extent found, Extent wanted) {
  if (found == wanted) return {};
  return Status::io(fmt::format("truth '{}' is {}x{} pixels; the output is {}x{}", path, found.width,
                                found.height, wanted.width, wanted.height));
}

struct OpenTruth {
  ImageReader reader;
  ChannelPlaces places;
  InputColour colour;
};

Result<OpenTruth> open_truth(const std::string& path, const TruthFiles& truth, Extent extent) {
  auto reader = ImageReader::open(path);
  if (!reader.ok()) return reader.status();
  if (Status status = check_whole(path); !status.ok()) return Status::io("truth " + status.message());
  const ImageHeader& header = reader->header();
  const std::vector<std::string> views = views_of(header);
  const bool has_view = std::find(views.begin(), views.end(), truth.view) != views.end();
  const std::string option = "--truth-colour";
  const auto picture = choose_picture(
      path, header, {.layer = truth.layer, .view = has_view ? truth.view : "", .option = option});
  if (!picture.ok()) return Status::io("truth " + picture.status().message());
  ChannelNames names;
  names[InputPlane::kColour] = picture->channels;
  const auto places = find_channels(path, header, names, option);
  if (!places.ok()) return Status::io("truth " + places.status().message());
  if (Status status = check_size(path, places->display.extent, extent); !status.ok()) return status;
  const ImagePart& part = header.parts[places->picture_part()];
  auto colour = InputColour::of(path, part);
  if (!part.chromaticities && colour.ok() && colour->is_light())  // the file says nothing of its colour
    colour = InputColour::of(path, part, truth.colour_space);
  if (!colour.ok()) return Status::io("truth " + colour.status().message());
  return OpenTruth{std::move(reader).value(), places.value(), std::move(colour).value()};
}

Result<std::vector<float>> read_truth(const std::string& path, const TruthFiles& truth, Extent extent) {
  auto open = open_truth(path, truth, extent);
  if (!open.ok()) return open.status();
  std::vector<float> rgba(static_cast<std::size_t>(extent.area()) * 4);
  std::vector<ChannelTarget> targets;
  for (std::size_t c = 0; c < 3; ++c) {
    targets.push_back({*open->places[InputPlane::kColour][c], ChannelType::kFloat, rgba.data() + c,
                       4 * sizeof(float), 4 * sizeof(float) * static_cast<std::size_t>(extent.width)});
  }
  if (Status status = open->reader.read(targets); !status.ok()) return status;
  for (std::size_t i = 3; i < rgba.size(); i += 4)
    rgba[i] = 1;  // nobody looks at it
  open->colour.apply(rgba);
  return rgba;
}

}  // namespace

Made SequenceOutput::made(std::int64_t frame) const {
  std::error_code error;
  const std::string file = path(frame);
  if (!std::filesystem::exists(file, error)) return Made::kNot;
  if (!check_whole(file).ok()) return Made::kOtherwise;
  const auto image = read_image(file);  // of a copy that was broken off blocks may be there, and hold zeros
  if (!image.ok() || image->extent != extent) return Made::kOtherwise;
  if (format_of(pattern) != FileFormat::kExr) return Made::kAsWanted;
  return settings_in(frame) == settings ? Made::kAsWanted : Made::kOtherwise;
}

std::string SequenceOutput::settings_in(std::int64_t frame) const {
  const auto reader = ImageReader::open(path(frame));
  if (!reader.ok()) return {};
  const Attribute* made_with = reader->header().attribute(kSettingsAttribute);
  const auto* text = made_with != nullptr ? std::get_if<std::string>(&made_with->value) : nullptr;
  return text != nullptr ? *text : "";
}

Status SequenceOutput::write_linear(std::int64_t frame, std::span<const float> rgba, float exposure,
                                    std::span<const Attribute> kept) const {
  std::vector<Attribute> attributes(kept.begin(), kept.end());
  for (Attribute& own : to_attributes({.index = frame}))
    attributes.push_back(std::move(own));
  attributes.push_back({kSettingsAttribute, settings});
  return write_light(path(frame), extent, rgba, stored, {tone_map, exposure}, attributes);
}

bool SequenceOutput::clips(std::span<const float> rgba) const {
  return format_of(pattern) == FileFormat::kExr && stored == ChannelType::kHalf && exceed_halves(rgba);
}

Status SequenceOutput::write_presented(std::int64_t frame, std::span<const std::uint8_t> rgba,
                                       std::span<const Attribute> kept) const {
  return write_picture(path(frame), extent, rgba.data(), 0, Alpha::kOpaque, kept);
}

Status SequenceOutput::check_names(std::span<const std::int64_t> frames,
                                   std::span<const std::string> inputs) const {
  if (Status status = pattern.check_count(static_cast<std::int64_t>(frames.size())); !status.ok())
    return status;
  std::set<FileIdentity> identities;
  std::set<std::string> names;
  FileIdentity identity;
  for (const std::string& input : inputs) {
    names.insert(std::filesystem::path(input).lexically_normal().string());
    if (identify(input, identity)) identities.insert(identity);
  }
  for (const std::int64_t frame : frames) {
    const std::string file = path(frame);
    const bool same_name = names.contains(std::filesystem::path(file).lexically_normal().string());
    if (same_name || (identify(file, identity) && identities.contains(identity))) {
      return Status::invalid(
          fmt::format("'{}' would overwrite an input file; give --out another folder or name", file));
    }
    std::error_code error;
    if (std::filesystem::is_directory(file, error))
      return Status::io(fmt::format("'{}' cannot be written: it is a folder", file));
  }
  return {};
}

Status SequenceOutput::prepare_folder(std::span<const std::int64_t> frames) const {
  // Without commit() no file stays; that of a run killed meanwhile is one of these frames', and so removed by the next.
  if (Status status = AtomicFile::create(path(frames.front())).status(); !status.ok()) return status;
  const std::string folder = folder_of(pattern.expand(0));
  const auto is_of_this_run = [&](const std::string& target) {
    const auto number = pattern.number_in(folder + target);
    // Number 0 is that of the file by which the command line tries whether --out can be written.
    return number && (*number == 0 || std::binary_search(frames.begin(), frames.end(), *number));
  };
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error), end;
       !error && entry != end; entry.increment(error)) {
    if (remove_abandoned(entry->path(), is_of_this_run))
      spdlog::debug("removed '{}', which an earlier run left behind", entry->path().string());
  }
  return {};
}

Result<std::unique_ptr<SequenceScores>> SequenceScores::create(const TruthFiles& truth, Extent extent,
                                                               std::span<const std::int64_t> frames,
                                                               bool keep_pictures) {
  if (Status status = ScoredFrames::check(extent, "--truth"); !status.ok()) return status;
  auto scores = std::unique_ptr<SequenceScores>(new SequenceScores(truth, extent));
  for (const std::int64_t frame : frames) {
    std::error_code error;
    const std::string path = truth.pattern.expand(frame);
    if (!std::filesystem::exists(path, error)) continue;
    if (const auto found = open_truth(path, truth, extent); !found.ok()) return found.status();
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
  const auto truth = read_truth(truth_.pattern.expand(frame), truth_, extent_);
  if (!truth.ok()) return truth.status();
  return scored_->add(frame, {extent_, pixels}, {extent_, truth.value()}, motion);
}

}  // namespace quincunx::tools
