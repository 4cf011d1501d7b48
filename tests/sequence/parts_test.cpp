// SPDX-License-Identifier: MIT
// Files of many parts, views and layers: which of them is the picture, and what goes with it.
#include "sequence_fixture.h"
#include "tools/exr_files.h"
#include "tools/record/exchange_attributes.h"
#include "tools/sequence/sequence_input.h"

namespace quincunx::tools {
namespace {

using Names = std::vector<std::string>;

struct PartOf {
  std::string name;
  Names channels;
  std::string view = {};
};

ImageHeader header_of(const std::vector<PartOf>& parts, const Names& views = {}) {
  ImageHeader header;
  header.views = views;
  for (const PartOf& from : parts) {
    ImagePart& part = header.parts.emplace_back();
    part.name = from.name;
    part.view = from.view;
    part.data.extent = part.display.extent = {24, 14};
    for (const std::string& channel : from.channels)
      part.channels.push_back({.name = channel});
  }
  return header;
}

// "beauty.R", or what is wrong.
std::string red_of(const ImageHeader& header, const PictureWish& wish = {}) {
  const auto picture = choose_picture("f", header, wish);
  if (!picture.ok()) return picture.status().message();
  ChannelNames names;
  names[InputPlane::kColour] = picture->channels;
  const auto places = find_channels("f", header, names);
  return places.ok() ? picture->channels[0] : places.status().message();
}

std::string beside(const ImageHeader& header, const PictureWish& wish, const Names& names) {
  const auto picture = choose_picture("f", header, wish);
  EXPECT_TRUE(picture.ok()) << picture.status().message();
  const auto found = channels_beside("f", header, picture.value(), names);
  return found.ok() ? fmt::format("{}", fmt::join(found.value(), " ")) : found.status().message();
}

const Names kRgb = {"R", "G", "B"}, kRgba = {"R", "G", "B", "A"}, kSmall = {"r", "g", "b", "a"};
const Names kLayer = {"diffuse.R", "diffuse.G", "diffuse.B"};

TEST(Pictures, AreOfOnePart) {
  const ImageHeader masked = header_of({{"a_mask", {"R"}}, {"beauty", kRgba}});
  EXPECT_EQ(choose_picture("f", masked, {})->channels,
            (Names{"beauty.R", "beauty.G", "beauty.B", "beauty.A"}));
  // Another part's alpha is another picture's.
  const ImageHeader apart = header_of({{"beauty", kRgb}, {"mask", {"A"}}});
  const auto places = find_channels("f", apart, {});
  ASSERT_TRUE(places.ok()) << places.status().message();
  EXPECT_FALSE((*places)[InputPlane::kColour][3]);
  EXPECT_EQ(red_of(header_of({{"red", {"R"}}, {"rest", {"G", "B"}}})),
            "'f' has channel 'G' in another part than 'red.R', and a picture is of one part");
}

TEST(Pictures, AreKnownByTheirUsualNames) {
  for (const auto& [parts, red] : std::vector<std::pair<std::vector<PartOf>, std::string>>{
           {{{"albedo", kRgb}, {"beauty", kRgba}}, "beauty.R"},
           {{{"N", kRgb}, {"ViewLayer.Combined", kRgba}}, "ViewLayer.Combined.R"},
           {{{"diffuse", kLayer}, {"anything", kRgba}}, "anything.R"},
           {{{"", {"C.a", "C.b", "C.g", "C.r"}}}, "C.r"},
           {{{"", {"R", "G", "B", "Combined.R", "Combined.G", "Combined.B"}}}, "R"},
           {{{"crypto00", kSmall}, {"crypto01", kSmall}, {"x", kRgba}}, "x.R"},
           {{{"depth", {"Y"}}, {"x", kRgba}}, "x.R"},
           {{{"key", {"Y", "A"}}, {"motion", {"X", "Y"}}}, "key.Y"},
           {{{"RGBA", {"red", "green", "blue"}}, {"x", kRgba}}, "RGBA.red"}})
    EXPECT_EQ(red_of(header_of(parts)), red);
  EXPECT_TRUE(red_of(header_of({{"", kLayer}})).ends_with("; --colour takes a layer of it: diffuse"));
}

TEST(Pictures, AreAskedForWhereSeveralCouldBeMeant) {
  const ImageHeader header = header_of({{"one", kRgba}, {"two", {"R", "G", "B", "x.R", "x.G", "x.B"}}});
  const auto picture = choose_picture("f", header, {});
  EXPECT_EQ(picture.status().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(picture.status().message(), "'f' holds several pictures; --colour takes a layer of it: one, two");
  EXPECT_EQ(red_of(header, {.layer = "two"}), "two.R");
  EXPECT_EQ(red_of(header, {.layer = "x"}), "two.x.R");
  EXPECT_EQ(red_of(header, {.layer = "two.x"}), "two.x.R");
  EXPECT_EQ(red_of(header, {.part = "one"}), "one.R");
  EXPECT_EQ(red_of(header, {.part = "1"}), "two.R");
  EXPECT_EQ(red_of(header, {.part = "2"}), "--part: 'f' has no part '2'; it has 2: one, two");
  const ImageHeader same = header_of({{"one", kLayer}, {"two", kLayer}});
  EXPECT_EQ(red_of(same, {.layer = "diffuse", .option = "--truth-colour"}),
            "'f' holds several pictures; --truth-colour takes a layer of it: one.diffuse, two.diffuse");
  EXPECT_EQ(red_of(same, {.layer = "diffuse", .part = "two"}), "two.diffuse.R");
}

TEST(Pictures, AreOfOneView) {
  const ImageHeader by_attribute = header_of(
      {{"depth.l", {"Z"}, "l"}, {"rgba.l", kRgba, "l"}, {"rgba.r", kRgba, "r"}, {"depth.r", {"Z"}, "r"}});
  EXPECT_EQ(red_of(by_attribute), "rgba.l.R");
  EXPECT_EQ(red_of(by_attribute, {.view = "r"}), "rgba.r.R");
  EXPECT_EQ(beside(by_attribute, {.view = "r"}, {"Z"}), "depth.r.Z");
  EXPECT_EQ(beside(by_attribute, {}, {"depth.Z"}), "depth.l.Z");
  EXPECT_EQ(beside(by_attribute, {}, {"depth.r.Z"}), "depth.r.Z");  // who names a view gets it
  EXPECT_EQ(red_of(by_attribute, {.view = "m"}),
            "--view-name: 'f' has no picture of a view 'm'; its views are l, r");
  const ImageHeader by_name =
      header_of({{"left_beauty", kRgba}, {"Right_beauty", kRgba}, {"depth_right", {"Z"}}});
  EXPECT_EQ(red_of(by_name), "left_beauty.R");
  EXPECT_EQ(red_of(by_name, {.view = "right"}), "Right_beauty.R");
  EXPECT_EQ(beside(by_name, {}, {"Z"}), "");
  EXPECT_EQ(beside(by_name, {.view = "right"}, {"Z"}), "depth_right.Z");
  ImageHeader in_one = header_of(
      {{"", {"R", "G", "B", "Z", "right.R", "right.G", "right.B", "right.Z", "m.u"}}}, {"left", "right"});
  EXPECT_EQ(red_of(in_one), "R");
  EXPECT_EQ(red_of(in_one, {.view = "right"}), "right.R");
  EXPECT_EQ(beside(in_one, {.view = "right"}, {"Z"}), "right.Z");
  EXPECT_EQ(beside(in_one, {}, {"m.u"}), "m.u");
  EXPECT_EQ(beside(in_one, {.view = "right"}, {"m.u"}), "");  // no view's own, so the default one's
  EXPECT_EQ(beside(in_one, {}, {"Z"}), "Z");
  in_one.parts[0].attributes = {{"defaultView", std::string("right")}};
  EXPECT_EQ(views_of(in_one).front(), "right");
  const ImageHeader prefixed =
      header_of({{"", {"left.R", "left.G", "left.B", "right.R", "right.G", "right.B"}}});
  EXPECT_EQ(red_of(prefixed), "left.R");
  EXPECT_EQ(red_of(prefixed, {.view = "right"}), "right.R");
  const ImageHeader right_alone = header_of({{"", {"right.R", "right.G", "right.B", "right.Z"}}});
  EXPECT_EQ(red_of(right_alone), "right.R");
  EXPECT_EQ(red_of(right_alone, {.view = "right"}), "right.R");
  EXPECT_EQ(beside(right_alone, {}, {"Z"}), "right.Z");
  // Names of lights are no views.
  EXPECT_EQ(red_of(header_of({{"beauty", kRgba}, {"light_right", kRgb}})), "beauty.R");
  EXPECT_EQ(red_of(header_of({{"light_left", kRgb}, {"beauty", kRgba}, {"light_right", kRgb}})), "beauty.R");
}

TEST(Pictures, HaveTheirOwnPartsMotionAndDepth) {
  const ImageHeader split = header_of({{"P", {"X", "Y", "Z"}},
                                       {"rgba", kRgba},
                                       {"depth", {"Z"}},
                                       {"backward", {"u", "v"}},
                                       {"forward", {"u", "v"}}});
  EXPECT_EQ(beside(split, {}, {"Z"}), "depth.Z");
  EXPECT_EQ(beside(split, {}, kBackwardChannels), "backward.u backward.v");
  EXPECT_EQ(beside(split, {}, {"u", "v"}),
            "'f' has channel 'u' in several parts; name one: 'backward.u' or 'forward.u'");
  EXPECT_EQ(beside(split, {}, {"P.X", "forward.v"}), "P.X forward.v");
  const ImageHeader blender = header_of({{"V.Combined", kRgba}, {"V.Mist", {"Z"}}, {"V.Depth", {"Z"}}});
  EXPECT_EQ(beside(blender, {}, {"Z"}), "V.Depth.Z");
  const ImageHeader two = header_of({{"far", {"R", "G", "B", "Z"}}, {"beauty", {"R", "G", "B", "Z"}}});
  EXPECT_EQ(beside(two, {}, {"Z"}), "beauty.Z");
  EXPECT_EQ(beside(two, {.part = "far"}, {"Z"}), "far.Z");
}

TEST(Pictures, AreFlatUnlessTheBeautyIsDeep) {
  ImageHeader header = header_of({{"deep", kRgba}, {"x", kRgba}});
  header.parts[0].deep = true;
  EXPECT_EQ(red_of(header), "x.R");
  header.parts[0].name = "beauty";
  EXPECT_EQ(red_of(header), "'f' holds deep pixels in channel 'beauty.R'; flat ones are needed");
}

// As a right eye's camera has them.
TEST(Pictures, HaveTheirOwnPartsAttributes) {
  ImageHeader header = header_of({{"left", kRgba}, {"right", kRgba}});
  header.parts[0].attributes = {{"jitter", Vec2{.5f, 0}}, {"quincunx:near", 2.0f}};
  header.parts[1].attributes = {{"jitter", Vec2{0, .25f}}};
  const auto attributes = frame_attributes("f", header, 1);
  ASSERT_TRUE(attributes.ok()) << attributes.status().message();
  EXPECT_EQ(attributes->jitter, (Vec2{0, .25f}));
  EXPECT_EQ(attributes->near_plane, 2.0f);
}

class Parts : public testing::SequenceTest {
 protected:
  static testing::ExrPart part(const std::string& name, const Names& channels, float value) {
    testing::ExrPart made =
        testing::simple_part({24, 14}, channels, std::vector<float>(24 * 14 * channels.size(), value));
    made.name = name;
    return made;
  }

  float red(int number) const {
    const LoadedImage made = image(output(number));
    return made.at(5, 5, made.channel("R"));
  }

  static constexpr const char* kSame = "--output 24x14 --method bilinear";
};

// The order of parts is the file's own affair.
TEST_F(Parts, AreFoundByNameInEveryFrame) {
  const auto beauty = part("beauty", kRgba, .5f), other = part("other", kRgba, 2),
             depth = part("Z", {"Z"}, 4);
  testing::write_exr_parts(input(1), {other, beauty, depth});
  testing::write_exr_parts(input(2), {depth, beauty, other});
  resolve_to("u", kSame);
  EXPECT_EQ(red(1), .5f);
  EXPECT_EQ(red(2), .5f);
  const auto listing = resolve(fmt::format("'{{}}/f.%04d.exr' -n {}", kSame));
  EXPECT_NE(listing.out.find("colour beauty.R,beauty.G,beauty.B,beauty.A; "), std::string::npos)
      << listing.out;
  testing::write_exr_parts(input(2), {depth, other});
  expect_refused(fmt::format("'{{}}/f.%04d.exr' --out '{{}}/o/u.%04d.exr' {}", kSame), 1,
                 "f.0002.exr' has no channel 'beauty.R'");
  const auto first = part("first", kRgba, 1);
  testing::write_exr_parts(input(1), {first, other});
  expect_refused(fmt::format("'{{}}/f.%04d.exr' --out '{{}}/o/u.%04d.exr' {}", kSame), 2,
                 "f.0001.exr' holds several pictures; --colour takes a layer of it: first, other");
}

TEST_F(Parts, TruthIsOfTheViewThatIsScored) {
  auto left = part("left", kRgba, .25f), right = part("right", kRgba, .5f);
  left.view = left.name, right.view = right.name;
  testing::write_exr_parts(input(1), {left, right});
  const auto scored = [&](const std::string& option) {
    const auto result =
        resolve(fmt::format("'{{}}/f.%04d.exr' --truth '{{}}/f.%04d.exr' {} {}", kSame, option));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out.find("       1       inf ") != std::string::npos;
  };
  EXPECT_TRUE(scored(""));
  EXPECT_TRUE(scored("--view-name right"));
}

TEST_F(Parts, AMaskIsOfTheViewThatIsResolved) {
  auto left = part("left", {"A"}, 0), right = part("right", {"A"}, 1);
  left.view = left.name, right.view = right.name;
  testing::write_exr_parts(folder_.file("m.exr"), {left, right});
  const auto place_for = [&](const std::string& view) {
    const auto mask = open_mask(folder_.file("m.exr"), {24, 14}, view);
    EXPECT_TRUE(mask.ok()) << mask.status().message();
    return mask->place.part;
  };
  EXPECT_EQ(place_for(""), 0);
  EXPECT_EQ(place_for("right"), 1);
  EXPECT_EQ(place_for("middle"), 0);
  right.sampling = 2;
  testing::write_exr_parts(folder_.file("m.exr"), {left, right});
  EXPECT_FALSE(open_mask(folder_.file("m.exr"), {24, 14}, "right").ok());
}

TEST_F(Parts, LayersMayHaveCommasInTheirNames) {
  testing::write_exr_parts(input(1), {part("",
                                           {"a, b.Combined.R", "a, b.Combined.G", "a, b.Combined.B",
                                            "a, b.Vector.X", "a, b.Vector.Y", "a, b.Depth.Z"},
                                           1)});
  const auto listing = resolve(
      "'{}/f.%04d.exr' -n --output 48x28 --colour 'a, b.Combined' --velocity 'a, b.Vector.X,a, b.Vector.Y' "
      "--velocity-convention blender --depth 'a, b.Depth.Z'");
  EXPECT_EQ(listing.exit_code, 0) << listing.err;
  EXPECT_NE(listing.out.find("velocity a, b.Vector.X,a, b.Vector.Y blender"), std::string::npos)
      << listing.out;
  expect_refused("'{}/f.%04d.exr' -n --velocity 'a, b.Vector.X,y'", 2, "is not two with a comma between");
}

TEST_F(Parts, WhatTheRunCannotReadIsFoundBefore) {
  auto sampled = part("", {"R", "G", "B", "Z"}, 1);
  sampled.sampling = 2;
  testing::write_exr_parts(input(1), {sampled});
  const std::string list = "'{}/f.%04d.exr' -n --output 48x28 --velocity none ";
  EXPECT_EQ(resolve(list).exit_code, 1);
  // A small picture in a display window that no memory holds.
  auto lost = part("", kRgba, 1);
  lost.display.extent = {16384, 16384};
  testing::write_exr_parts(input(1), {lost});
  const auto listing = resolve(list);
  EXPECT_EQ(listing.exit_code, 1);
  EXPECT_NE(listing.out.find("has a display window of 16384x16384 pixels, and 24x14 of them with data"),
            std::string::npos)
      << listing.out;
}

}  // namespace
}  // namespace quincunx::tools
