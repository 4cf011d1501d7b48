// SPDX-License-Identifier: MIT
// Device profiles as JSON: the tuned ones of cache_folder(), the shipped ones of host/profiles. In device_profile.cpp.
#pragma once

#include <string>

#include "quincunx/advanced/device_profile.h"
#include "quincunx/device.h"

namespace quincunx {

// The device and driver that a profile belongs to.
struct ProfileOwner {
  std::string platform;
  std::string device;
  std::string kind;  // "cpu"
  std::string driver;
};
ProfileOwner owner_of(const DeviceInfo& info);

struct ProfileFile {
  ProfileOwner owner;
  DeviceProfile profile;  // its source is left to the reader
};

// Reads a file's text. Errors: kInvalidArgument, one sentence without the file's name: what is wrong and what would be
// right. Pure.
Result<ProfileFile> parse_profile(const std::string& text);

std::string profile_text(const ProfileFile& file);

// Finds the tuned, shipped or default profile. A tuned file that is damaged, of another version or of another device or
// driver is warned of in one sentence, and passed over.
DeviceProfile find_profile(const Device::Impl& device);

}  // namespace quincunx
