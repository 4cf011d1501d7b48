// SPDX-License-Identifier: MIT
#include "bench/harness/copy_kernel.h"

#include <fmt/format.h>

#include <type_traits>
#include <utility>
#include <vector>

namespace quincunx::bench {
namespace {

constexpr std::size_t kGroup = 64;

constexpr const char* kSource = R"(
__kernel void copy(__global const float4* source, __global float4* output, int width, int height) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= width || y >= height) return;
  output[y * width + x] = source[y * width + x];
})";

template <auto release>
struct Releases {
  template <typename Handle>
  void operator()(Handle* handle) const {
    release(handle);
  }
};
using ProgramHandle = std::unique_ptr<std::remove_pointer_t<cl_program>, Releases<clReleaseProgram>>;
using KernelHandle = std::unique_ptr<std::remove_pointer_t<cl_kernel>, Releases<clReleaseKernel>>;
using EventHandle = std::unique_ptr<std::remove_pointer_t<cl_event>, Releases<clReleaseEvent>>;

Status failed(const char* call, cl_int code) {
  return Status::device(fmt::format("the copy kernel: {} failed with {}", call, code));
}

Result<Image> picture_of(const Device& device, Extent extent) {
  auto image = device.allocate(extent, PixelFormat::kRGBA32F);
  if (!image.ok()) return image;
  const std::vector<float> texels(static_cast<std::size_t>(extent.area()) * 4, 0.5f);
  if (Status status = device.upload(image->view(), extent, texels.data()); !status.ok()) return status;
  return image;
}

}  // namespace

struct CopyKernel::Impl {
  Device device;
  Extent extent;
  Image source;
  Image output;
  ProgramHandle program = {};
  KernelHandle kernel = {};

  Status build();
};

Status CopyKernel::Impl::build() {
  cl_int code = CL_SUCCESS;
  const char* text = kSource;
  program.reset(clCreateProgramWithSource(device.context(), 1, &text, nullptr, &code));
  if (code != CL_SUCCESS) return failed("clCreateProgramWithSource", code);
  const cl_device_id id = device.id();
  code = clBuildProgram(program.get(), 1, &id, "-cl-std=CL1.2", nullptr, nullptr);
  if (code != CL_SUCCESS) return failed("clBuildProgram", code);
  kernel.reset(clCreateKernel(program.get(), "copy", &code));
  if (code != CL_SUCCESS) return failed("clCreateKernel", code);
  cl_uint index = 0;
  const auto set = [&](const auto& argument) {
    if (code == CL_SUCCESS) code = clSetKernelArg(kernel.get(), index++, sizeof(argument), &argument);
  };
  set(source.view().memory);
  set(output.view().memory);
  set(cl_int{extent.width});
  set(cl_int{extent.height});
  return code == CL_SUCCESS ? Status() : failed("clSetKernelArg", code);
}

CopyKernel::CopyKernel(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CopyKernel::CopyKernel(CopyKernel&&) noexcept = default;
CopyKernel& CopyKernel::operator=(CopyKernel&&) noexcept = default;
CopyKernel::~CopyKernel() = default;

Result<CopyKernel> CopyKernel::create(const Device& device, Extent extent) {
  auto source = picture_of(device, extent);
  if (!source.ok()) return source.status();
  auto output = picture_of(device, extent);
  if (!output.ok()) return output.status();
  auto impl =
      std::make_unique<Impl>(Impl{device, extent, std::move(source).value(), std::move(output).value()});
  if (Status status = impl->build(); !status.ok()) return status;
  return CopyKernel(std::move(impl));
}

std::uint64_t CopyKernel::bytes() const {
  return 2 * static_cast<std::uint64_t>(impl_->extent.area()) * bytes_per_pixel(PixelFormat::kRGBA32F);
}

Result<double> CopyKernel::run() {
  const auto columns = static_cast<std::size_t>(impl_->extent.width);
  const std::size_t global[] = {(columns + kGroup - 1) / kGroup * kGroup,
                                static_cast<std::size_t>(impl_->extent.height)};
  const std::size_t local[] = {kGroup, 1};
  cl_event raw = nullptr;
  cl_int code = clEnqueueNDRangeKernel(impl_->device.queue(), impl_->kernel.get(), 2, nullptr, global, local,
                                       0, nullptr, &raw);
  const EventHandle event(raw);
  if (code != CL_SUCCESS) return failed("clEnqueueNDRangeKernel", code);
  code = clWaitForEvents(1, &raw);
  if (code != CL_SUCCESS) return failed("clWaitForEvents", code);
  cl_ulong start = 0;
  cl_ulong end = 0;
  code = clGetEventProfilingInfo(raw, CL_PROFILING_COMMAND_START, sizeof(start), &start, nullptr);
  if (code == CL_SUCCESS)
    code = clGetEventProfilingInfo(raw, CL_PROFILING_COMMAND_END, sizeof(end), &end, nullptr);
  if (code != CL_SUCCESS) return failed("clGetEventProfilingInfo", code);
  return static_cast<double>(end - start) * 1e-6;
}

}  // namespace quincunx::bench
