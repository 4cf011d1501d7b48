/* SPDX-License-Identifier: MIT */
/* The same client in C99: scales a picture in host memory from 32x32 to 64x48, and sees a bad frame refused. */
#include <quincunx/quincunx.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kRender = 32, kWidth = 64, kHeight = 48 };

static int fail(const char* what) {
  fprintf(stderr, "%s: %s\n", what, quincunx_last_error());
  return 1;
}

static quincunx_image host_image(int format, int width, int height, float* texels) {
  quincunx_image image = {sizeof image};
  image.place = QUINCUNX_HOST;
  image.format = format;
  image.width = width;
  image.height = height;
  image.memory = texels;
  return image;
}

/* Two frames of one colour, then one that is bad. */
static int resolve(quincunx_service* service, float* colour, float* picture) {
  const float value[4] = {0.25f, 0.5f, 2.0f, 1.0f};
  const quincunx_image in = host_image(QUINCUNX_RGBA32F, kRender, kRender, colour);
  const quincunx_image out = host_image(QUINCUNX_RGBA32F, kWidth, kHeight, picture);
  quincunx_inputs inputs = {sizeof inputs};
  quincunx_outputs outputs = {sizeof outputs};
  quincunx_report report = {sizeof report};
  quincunx_pass_report passes[QUINCUNX_MAX_PASSES];
  int i;
  for (i = 0; i < kRender * kRender * 4; ++i)
    colour[i] = value[i % 4];
  inputs.colour = &in;
  inputs.render_width = inputs.render_height = kRender;
  outputs.linear = &out;
  for (i = 0; i < 2; ++i) {
    inputs.frame_index = (uint64_t)i;
    if (quincunx_dispatch(service, &inputs, &outputs, NULL) != QUINCUNX_OK) return fail("dispatch");
  }
  for (i = 0; i < kWidth * kHeight * 4; ++i) {
    if (!(fabsf(picture[i] - value[i % 4]) < 1e-6f)) {
      fprintf(stderr, "channel %d is %g\n", i, (double)picture[i]);
      return 1;
    }
  }
  report.passes = passes;
  report.pass_capacity = QUINCUNX_MAX_PASSES;
  if (quincunx_next_report(service, &report) != QUINCUNX_OK) return fail("next_report");
  printf("frame %d: %s, %g x %g\n", (int)report.frame_index, passes[0].kernel, (double)report.ratio_x,
         (double)report.ratio_y);
  inputs.render_width = kRender + 1;
  if (quincunx_dispatch(service, &inputs, &outputs, NULL) != QUINCUNX_INVALID_ARGUMENT ||
      strstr(quincunx_last_error(), "colour.extent is 32x32; it must hold the viewport of 33x32") == NULL) {
    return fail("a bad frame was not refused as it should be");
  }
  return 0;
}

int main(void) {
  quincunx_settings settings = {sizeof settings};
  quincunx_device* device = NULL;
  quincunx_plan* plan = NULL;
  quincunx_service* service = NULL;
  float* colour = malloc(sizeof(float) * 4 * kRender * kRender);
  float* picture = malloc(sizeof(float) * 4 * kWidth * kHeight);
  int result = 1;
  if (quincunx_api_version() < QUINCUNX_API_VERSION || quincunx_settings_init(&settings) != QUINCUNX_OK ||
      colour == NULL || picture == NULL) {
    result = fail("start");
  } else {
    settings.method = QUINCUNX_BILINEAR;
    settings.output_width = settings.target_width = kWidth;
    settings.output_height = settings.target_height = kHeight;
    settings.colour_format = QUINCUNX_RGBA32F;
    settings.present = 0;
    if (quincunx_plan_create(&settings, &plan) != QUINCUNX_OK ||
        quincunx_device_open("cpu", &device) != QUINCUNX_OK ||
        quincunx_service_create(device, plan, &service) != QUINCUNX_OK) {
      result = fail("create");
    } else {
      result = resolve(service, colour, picture);
    }
  }
  quincunx_device_destroy(device);
  quincunx_plan_destroy(plan);
  quincunx_service_destroy(service);
  free(colour);
  free(picture);
  return result;
}
