// SPDX-License-Identifier: MIT
#include "bench/harness/measuring.h"

#include <fmt/format.h>
#include <time.h>

#include <utility>
#include <vector>

#include "quincunx/advanced/pass_timer.h"
#include "src/device/opencl.h"

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

Status failed(const cl::Error& error) {
  return Status::device(fmt::format("the copy kernel: {} failed with {}", error.what(), error.err()));
}

Result<Image> picture_of(const Device& device, Extent extent) {
  auto image = device.allocate(extent, PixelFormat::kRGBA32F);
  if (!image.ok()) return image;
  const std::vector<float> texels(static_cast<std::size_t>(extent.area()) * 4, 0.5f);
  if (Status status = device.upload(image->view(), extent, texels.data()); !status.ok()) return status;
  return image;
}

}  // namespace

Status check_event_times(const Device& device) {
  if (pass_timer(device) == PassTimer::kEvents) return {};
  return Status::unsupported(fmt::format(
      "the benchmark measures by OpenCL events, and those of '{}' do not agree with the host's clock; "
      "choose another device with --device",
      device.info().name));
}

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

struct CopyKernel::Impl {
  Extent extent;
  Image source;
  Image output;
  cl::CommandQueue queue;
  cl::Kernel kernel;
};

CopyKernel::CopyKernel(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CopyKernel::CopyKernel(CopyKernel&&) noexcept = default;
CopyKernel& CopyKernel::operator=(CopyKernel&&) noexcept = default;
CopyKernel::~CopyKernel() = default;

Result<CopyKernel> CopyKernel::create(const Device& device, Extent extent) {
  auto source = picture_of(device, extent);
  if (!source.ok()) return source.status();
  auto output = picture_of(device, extent);
  if (!output.ok()) return output.status();
  try {
    cl::Program program(borrow<cl::Context>(device.context()), kSource);
    program.build(borrow<cl::Device>(device.id()), "-cl-std=CL1.2");
    cl::Kernel kernel(program, "copy");
    kernel.setArg(0, sizeof(cl_mem), &source->view().memory);
    kernel.setArg(1, sizeof(cl_mem), &output->view().memory);
    kernel.setArg(2, cl_int{extent.width});
    kernel.setArg(3, cl_int{extent.height});
    return CopyKernel(
        std::make_unique<Impl>(Impl{extent, std::move(source).value(), std::move(output).value(),
                                    borrow<cl::CommandQueue>(device.queue()), std::move(kernel)}));
  } catch (const cl::Error& error) {
    return failed(error);
  }
}

std::uint64_t CopyKernel::bytes() const {
  return 2 * static_cast<std::uint64_t>(impl_->extent.area()) * bytes_per_pixel(PixelFormat::kRGBA32F);
}

Result<double> CopyKernel::run() {
  const auto [width, height] = impl_->extent;
  const cl::NDRange items((static_cast<std::size_t>(width) + kGroup - 1) / kGroup * kGroup,
                          static_cast<std::size_t>(height));
  try {
    cl::Event event;
    impl_->queue.enqueueNDRangeKernel(impl_->kernel, cl::NullRange, items, cl::NDRange(kGroup, 1), nullptr,
                                      &event);
    event.wait();
    const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    return static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() - start) * 1e-6;
  } catch (const cl::Error& error) {
    return failed(error);
  }
}

}  // namespace quincunx::bench
