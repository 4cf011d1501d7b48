// SPDX-License-Identifier: MIT
#include "tools/image/contact_sheet.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "tools/image/display_light.h"
#include "tools/image/false_colour.h"
#include "tools/image/image_io.h"

namespace quincunx::tools {

namespace {

// Dark and neutral, so that the pictures' colours are judged against grey; one warm accent.
constexpr Rgb kCardBackground{34, 34, 37};
constexpr Rgb kBarTrack{52, 52, 56};
constexpr Rgb kAccent{232, 163, 61};

constexpr int kMargin = 40;
constexpr int kGap = 20;
constexpr int kTitleSize = 38;
constexpr int kSubtitleSize = 19;
constexpr int kCaptionSize = 16;
constexpr int kHeaderHeight = 86;  // from the upper margin to the first row of thumbnails
constexpr int kBarHeight = 4;
constexpr int kCaptionHeight = 38;  // height of the strip below the bar
constexpr int kCaptionInset = 12;
constexpr int kCaptionBaseline = 25;
constexpr double kWantedAspect = 1.5;
// A gap in the last row looks as bad as an aspect that is off by e^0.25.
constexpr double kCostOfHoles = 0.25;

// Returns the frame at the thumbnail's size: box filtered in linear light, as OpenImageIO's resize does it.
std::vector<std::uint8_t> shrunk(Extent from, const std::uint8_t* rgba, std::size_t row_bytes, Extent to) {
  using OIIO::ImageSpec, OIIO::TypeDesc;
  OIIO::ImageBuf light(ImageSpec(from.width, from.height, 3, TypeDesc::FLOAT));
  for (OIIO::ImageBuf::Iterator<float> pixel(light); !pixel.done(); ++pixel) {
    const std::uint8_t* texel = rgba + static_cast<std::size_t>(pixel.y()) * row_bytes + 4 * pixel.x();
    for (int c = 0; c < 3; ++c)
      pixel[c] = linear_of_srgb(static_cast<float>(texel[c]) / 255);
  }
  OIIO::ImageBuf small(ImageSpec(to.width, to.height, 3, TypeDesc::FLOAT));
  OIIO::ImageBufAlgo::resize(small, light, "box");
  std::vector<std::uint8_t> rgb;
  rgb.reserve(static_cast<std::size_t>(to.area()) * 3);
  for (OIIO::ImageBuf::ConstIterator<float> pixel(small); !pixel.done(); ++pixel)
    for (int c = 0; c < 3; ++c)
      rgb.push_back(static_cast<std::uint8_t>(std::lround(srgb_of_linear(pixel[c]) * 255)));
  return rgb;
}

int columns_for(int count, Extent cell) {
  int best = 1;
  double best_distance = 1e30;
  for (int columns = 1; columns <= count; ++columns) {
    const int rows = (count + columns - 1) / columns;
    const double aspect = static_cast<double>(columns * cell.width) / (rows * cell.height + kHeaderHeight);
    const int holes = rows * columns - count;
    const double distance = std::abs(std::log(aspect / kWantedAspect)) +
                            (holes > 0 ? kCostOfHoles + kCostOfHoles * holes / columns : 0);
    if (distance < best_distance) {
      best_distance = distance;
      best = columns;
    }
  }
  return best;
}

// Cuts the text until it fits, with an ellipsis; never inside a UTF-8 character.
std::string fit(std::string text, int size_px, Face face, int width_px) {
  if (text_width(text, size_px, face) <= width_px) return text;
  while (!text.empty() && text_width(text + "…", size_px, face) > width_px) {
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U)
      text.pop_back();
    if (!text.empty()) text.pop_back();
  }
  return text + "…";
}

void copy_into(Canvas& canvas, int x, int y, Extent extent, const std::vector<std::uint8_t>& rgb) {
  const std::size_t row = static_cast<std::size_t>(extent.width) * 3;
  for (int j = 0; j < extent.height; ++j) {
    std::copy_n(&rgb[j * row], row,
                &canvas.rgb[(static_cast<std::size_t>(y + j) * canvas.extent.width + x) * 3]);
  }
}

void draw_caption(Canvas& canvas, int x, int y, int width, const ContactSheetCaption& caption) {
  const int inner = width - 2 * kCaptionInset;
  const std::string right = fit(caption.right, kCaptionSize, Face::kSans, inner);
  const int left_width = inner - text_width(right, kCaptionSize, Face::kSans) - kCaptionInset;
  const std::string left = fit(caption.left, kCaptionSize, Face::kSansBold, std::max(left_width, 0));
  draw_text(canvas, x + kCaptionInset, y + kCaptionBaseline, left, kCaptionSize, Face::kSansBold,
            kBrightText);
  draw_text(canvas, x + width - kCaptionInset, y + kCaptionBaseline, right, kCaptionSize, Face::kSans,
            kDimText, Align::kRight);
}

}  // namespace

std::vector<int> evenly_spaced(int total, int count) {
  std::vector<int> frames;
  count = std::min(count, total);
  for (int i = 0; i < count; ++i) {
    frames.push_back(
        count == 1 ? 0 : static_cast<int>(std::lround(static_cast<double>(i) * (total - 1) / (count - 1))));
  }
  return frames;
}

ContactSheet::ContactSheet(ContactSheetSettings settings) : settings_(std::move(settings)) {}

Status ContactSheet::add(Extent extent, const std::uint8_t* rgba, const ContactSheetCaption& caption,
                         std::size_t row_bytes) {
  if (extent.width < 1 || extent.height < 1 || rgba == nullptr) {
    return Status::invalid(fmt::format("contact sheet: a frame of {}x{} pixels{} cannot be shown",
                                       extent.width, extent.height,
                                       rgba == nullptr ? " without texels" : ""));
  }
  if (row_bytes == 0) row_bytes = static_cast<std::size_t>(extent.width) * 4;
  Extent small = extent;
  if (extent.width > settings_.thumbnail_width) {
    small.width = std::max(settings_.thumbnail_width, 1);
    small.height = std::max(
        1, static_cast<int>(std::lround(static_cast<double>(extent.height) * small.width / extent.width)));
  }
  thumbnails_.push_back({small, shrunk(extent, rgba, row_bytes, small), caption});
  return {};
}

Status ContactSheet::write(const std::string& path) const {
  if (thumbnails_.empty()) return Status::invalid(fmt::format("'{}': a contact sheet needs a frame", path));
  if (!has_fonts()) {
    spdlog::warn("contact sheet: no text, because DejaVu Sans is missing; install fonts-dejavu-core");
  }
  Extent picture;
  for (const Thumbnail& thumbnail : thumbnails_) {
    picture.width = std::max(picture.width, thumbnail.extent.width);
    picture.height = std::max(picture.height, thumbnail.extent.height);
  }
  const int count = size();
  const Extent cell = {picture.width + kGap, picture.height + kBarHeight + kCaptionHeight + kGap};
  const int columns =
      std::clamp(settings_.columns > 0 ? settings_.columns : columns_for(count, cell), 1, count);
  const int rows = (count + columns - 1) / columns;
  const int width = 2 * kMargin + columns * cell.width - kGap;
  Canvas canvas({width, 2 * kMargin + kHeaderHeight + rows * cell.height - kGap}, kCanvasBackground);

  const int inner = width - 2 * kMargin;
  draw_text(canvas, kMargin, kMargin + 30, fit(settings_.title, kTitleSize, Face::kSansBold, inner),
            kTitleSize, Face::kSansBold, kBrightText);
  draw_text(canvas, kMargin, kMargin + 62, fit(settings_.subtitle, kSubtitleSize, Face::kSans, inner),
            kSubtitleSize, Face::kSans, kDimText);
  for (int i = 0; i < count; ++i) {
    const Thumbnail& thumbnail = thumbnails_[i];
    const int x = kMargin + i % columns * cell.width;
    const int y = kMargin + kHeaderHeight + i / columns * cell.height;
    const int bar_y = y + picture.height;
    canvas.fill(x, y, {picture.width, cell.height - kGap}, kCardBackground);
    copy_into(canvas, x + (picture.width - thumbnail.extent.width) / 2, y, thumbnail.extent, thumbnail.rgb);
    if (thumbnail.caption.bar >= 0) {
      canvas.fill(x, bar_y, {picture.width, kBarHeight}, kBarTrack);
      const float part = std::min(thumbnail.caption.bar, 1.0f);
      canvas.fill(x, bar_y,
                  {static_cast<int>(std::lround(part * static_cast<float>(picture.width))), kBarHeight},
                  kAccent);
    }
    draw_caption(canvas, x, bar_y + kBarHeight, picture.width, thumbnail.caption);
  }
  // write_picture takes four channels.
  std::vector<std::uint8_t> rgba(static_cast<std::size_t>(canvas.extent.area()) * 4, 255);
  for (std::size_t i = 0; i < rgba.size() / 4; ++i)
    std::copy_n(&canvas.rgb[i * 3], 3, &rgba[i * 4]);
  return write_picture(path, canvas.extent, rgba.data());
}

}  // namespace quincunx::tools
