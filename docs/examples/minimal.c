/* SPDX-License-Identifier: MIT */
/* From frames in host memory to a picture of twice their width and height, in C99.
 *
 *   minimal_c PICTURE.ppm */
#include <quincunx/quincunx.h>

#include <math.h>
#include <stdio.h>

enum { kWidth = 640, kHeight = 360, kRenderWidth = 320, kRenderHeight = 180 };

static float colour[kRenderHeight][kRenderWidth][4], depth[kRenderHeight][kRenderWidth];
static float velocity[kRenderHeight][kRenderWidth][2];
static unsigned char picture[kHeight][kWidth][4];

/* Your renderer: thin lines that go to the right, of which a frame sees one place a pixel. */
static void draw(const float jitter[2], int frame) {
  const float speed = 0.3f / kWidth; /* uv a frame */
  for (int y = 0; y < kRenderHeight; ++y) {
    for (int x = 0; x < kRenderWidth; ++x) {
      const float u = (x + 0.5f + jitter[0]) / kRenderWidth, v = (y + 0.5f + jitter[1]) / kRenderHeight;
      const float across = 40 * (u - speed * frame) + 11 * v;
      for (int c = 0; c < 4; ++c)
        colour[y][x][c] = c == 3 ? 1.0f : across - floorf(across) < 0.15f ? 0.8f : 0.02f; /* linear light */
      depth[y][x] = 0.01f;
      velocity[y][x][0] = speed; /* where it is less where it was */
    }
  }
}

static int fail(void) {
  fprintf(stderr, "%s\n", quincunx_last_error());
  return 1;
}

int main(int argc, char** argv) {
  quincunx_settings settings = {sizeof settings};
  quincunx_plan* plan = NULL;
  quincunx_device* device = NULL;
  quincunx_service* service = NULL;
  if (quincunx_settings_init(&settings)) return fail();
  settings.transparents = 0;
  settings.output_width = kWidth;
  settings.output_height = kHeight;
  settings.target_width = kRenderWidth;
  settings.target_height = kRenderHeight;
  settings.colour_format = QUINCUNX_RGBA32F;
  settings.velocity_format = QUINCUNX_RG32F;
  if (quincunx_plan_create(&settings, &plan) || quincunx_device_open("", &device) ||
      quincunx_service_create(device, plan, &service)) {
    return fail();
  }

  const quincunx_image images[] = {
      {sizeof(quincunx_image), QUINCUNX_HOST, QUINCUNX_RGBA32F, kRenderWidth, kRenderHeight, 0, 0, colour},
      {sizeof(quincunx_image), QUINCUNX_HOST, QUINCUNX_R32F, kRenderWidth, kRenderHeight, 0, 0, depth},
      {sizeof(quincunx_image), QUINCUNX_HOST, QUINCUNX_RG32F, kRenderWidth, kRenderHeight, 0, 0, velocity},
      {sizeof(quincunx_image), QUINCUNX_HOST, QUINCUNX_RGBA8, kWidth, kHeight, 0, 0, picture}};
  quincunx_inputs inputs = {sizeof inputs, &images[0], &images[1], &images[2]};
  const quincunx_outputs outputs = {sizeof outputs, NULL, &images[3]};
  inputs.render_width = kRenderWidth;
  inputs.render_height = kRenderHeight;
  for (int n = 0; n < 64; ++n) {
    float jitter[2];
    quincunx_jitter((uint64_t)n, kRenderWidth, kRenderHeight, kWidth, kHeight, jitter);
    draw(jitter, n);
    inputs.jitter_x = jitter[0];
    inputs.jitter_y = jitter[1];
    if (quincunx_dispatch(service, &inputs, &outputs, NULL)) return fail();
  }
  quincunx_service_destroy(service);
  quincunx_device_destroy(device);
  quincunx_plan_destroy(plan);

  FILE* file = fopen(argc > 1 ? argv[1] : "picture.ppm", "wb");
  if (file == NULL) return 1;
  fprintf(file, "P6 %d %d 255\n", kWidth, kHeight);
  for (int i = 0; i < kWidth * kHeight; ++i)
    fwrite(picture[i / kWidth][i % kWidth], 1, 3, file);
  return fclose(file);
}
