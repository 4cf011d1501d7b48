/* SPDX-License-Identifier: MIT */
/* c/control.h: chooses each frame's resolution, and its method, from the times of frames past. For quincunx.h, whose
 * rules hold here: sizes of structs, errors, ownership. All objects are pure, without clock or device: the same calls
 * give the same choices. One thread at a time calls an object. The C++ headers say more of each field.
 *
 *   quincunx_controller_settings settings = {sizeof settings};
 *   quincunx_controller_settings_init(&settings);           then output_*, target_ms, and kind
 *   quincunx_controller_create(&settings, &controller);
 *   each frame: quincunx_controller_choice(controller, &choice); draw at its extent;
 *               for every timer that has come back, oldest first: quincunx_controller_observe(controller, &timing) */
#ifndef QUINCUNX_C_CONTROL_H
#define QUINCUNX_C_CONTROL_H

#include "quincunx/quincunx.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct quincunx_controller quincunx_controller;
typedef struct quincunx_costs quincunx_costs;
typedef struct quincunx_front quincunx_front;
typedef struct quincunx_output_follower quincunx_output_follower;
typedef struct quincunx_detail_follower quincunx_detail_follower;

enum quincunx_controller_kind {
  QUINCUNX_CONTROL_PROPORTIONAL = 0, /* resolution_controller.h */
  QUINCUNX_CONTROL_MINIMUM_OF_N = 1, /* the same */
  QUINCUNX_CONTROL_PREDICTIVE = 2,   /* predictive_controller.h */
  QUINCUNX_CONTROL_QUALITY = 3       /* quality_controller.h: chooses the method, too */
};
enum quincunx_order { QUINCUNX_HORIZONTAL_FIRST = 0, QUINCUNX_HORIZONTAL_ONLY = 1, QUINCUNX_BOTH_AXES = 2 };
enum quincunx_cpu_bound { QUINCUNX_HOLD = 0, QUINCUNX_FOLLOW = 1 };
/* Classes of scenes, of which a mix has shares. */
enum {
  QUINCUNX_STILL = 0,
  QUINCUNX_PAN = 1,
  QUINCUNX_OBJECTS = 2,
  QUINCUNX_THIN = 3,
  QUINCUNX_LIGHT = 4,
  QUINCUNX_ZOOM = 5,
  QUINCUNX_SCENE_CLASSES = 6
};

typedef struct quincunx_controller_settings {
  size_t struct_size; /* sizeof(quincunx_controller_settings) */
  int32_t kind;       /* default QUINCUNX_CONTROL_PREDICTIVE */
  /* The ladder of extents to choose from. */
  int32_t output_width, output_height; /* pixels, each in [1, 32768]; no default */
  int32_t order;                       /* of the axes; default QUINCUNX_HORIZONTAL_FIRST */
  int32_t step;                        /* pixels, at least 1; default 2 */
  int32_t min_width, min_height;       /* pixels, at least 1; default 8 */
  int32_t buffers;                     /* predictive, quality: of the swap chain, in [2, 8]; default 3 */
  double min_scale;                    /* per axis, of the output; above 0; default 0.5 */
  double max_scale;                    /* in [min_scale, 2]; default 1 */
  double target_ms;                    /* that a frame may take, in (0, 60000]; default 1000 / 60 */
  double rate;                         /* proportional: in (0, 1]; default 0.05 */
  double spike_ratio;                  /* proportional: at least 1; default 1.5 */
  double factor;                       /* minimum of N: in (0, 1]; default 0.2 */
  double margin;                       /* minimum of N: in (0, 1]; default 0.87 */
  int32_t count;                       /* minimum of N: N, in [1, 1000]; default 5 */
  /* The following fields are of predictive and quality. */
  int32_t cpu_bound; /* default QUINCUNX_HOLD */
  double fixed_part; /* first guess of what does not scale, in [0, 0.9]; default 0.25 */
  /* Replaces that guess, if it spans enough resolutions; copied; default NULL. */
  const quincunx_costs* calibration;
  double blur_start_px;  /* mean streak of motion blur, output pixels, from which it counts; default 4 */
  double blur_full_px;   /* from which blur_min_scale is the limit; above blur_start_px; default 24 */
  double blur_min_scale; /* per axis, in (0, 1]; default 0.71 */
  int32_t blur_aware;    /* the three above count; default 0 */
  /* The following fields are of quality. */
  int32_t fade_frames; /* over which a change of method is faded in, in [0, 60]; 0: at once; default 6 */
  const quincunx_front* front; /* copied; default NULL: the one that is built in */
  const char* const* methods;  /* names of quincunx_variant_name(); default NULL: all of the front */
  int32_t method_count;        /* default 0 */
  int32_t padding;             /* 0 */
  double hysteresis;   /* part of the expected error that a change has to save, in [0, 1); default 0.03 */
  double rest_seconds; /* between two changes of method, in [0, 60]; default 1 */
} quincunx_controller_settings;

/* Times of one past frame. Zero means not known unless a comment says otherwise. */
typedef struct quincunx_timing {
  size_t struct_size;   /* sizeof(quincunx_timing) */
  uint64_t frame;       /* its number; rises from call to call, gaps are allowed */
  uint64_t next_frame;  /* number of the frame that the choice will be drawn as; 0: the one after `frame` */
  int32_t render_width; /* that it was drawn at; at least 1 */
  int32_t render_height;
  double gpu_ms;                   /* busy time of its critical path, resolve included; must be above 0 */
  double cpu_ms;                   /* that the processor needed to prepare it */
  double interval_ms;              /* from the previous frame's start on the device to its own */
  int32_t queued;                  /* finished frames not yet shown when it was finished, itself included */
  int32_t missed_vsyncs;           /* refreshes without a new frame before it was shown; 0 means none */
  double blur_px;                  /* mean length of its motion blur streaks in output pixels; 0 means none */
  double resolve_ms;               /* quality: the method's passes' part of gpu_ms */
  const quincunx_content* content; /* quality: its content; NULL: as the frame before */
} quincunx_timing;

/* How to draw and resolve the next frame. */
typedef struct quincunx_choice {
  size_t struct_size;   /* sizeof(quincunx_choice) */
  int32_t render_width; /* a rung of the ladder */
  int32_t render_height;
  int32_t rung; /* its number, from 0, the smallest */
  int32_t padding;
  /* Static names, "temporal:fast", as quincunx_settings_set_method() takes them. */
  const char* method;      /* NULL: not chosen */
  const char* fading_from; /* resolve with this, too, and give it as inputs.fade; NULL: with nothing else */
  double weight;           /* of `method`'s picture, in (0, 1]; 1 unless fading */
} quincunx_choice;

/* Sets every field to its default but struct_size, which it reads. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_controller_settings_init(quincunx_controller_settings* settings);

/* Errors: QUINCUNX_INVALID_ARGUMENT for a field outside its range that counts for the kind. */
QUINCUNX_API quincunx_status quincunx_controller_create(const quincunx_controller_settings* settings,
                                                        quincunx_controller** controller);
QUINCUNX_API void quincunx_controller_destroy(quincunx_controller* controller);
/* "predictive"; static. */
QUINCUNX_API const char* quincunx_controller_name(const quincunx_controller* controller);
/* Learns from one frame and chooses for the next. Errors: QUINCUNX_INVALID_ARGUMENT for a frame number that is not
 * above the last accepted one, and a field that cannot be; nothing has changed then, so a caller may ignore it. */
QUINCUNX_API quincunx_status quincunx_controller_observe(quincunx_controller* controller,
                                                         const quincunx_timing* timing);
/* Before the first frame it is the highest rung. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_controller_choice(const quincunx_controller* controller,
                                                        quincunx_choice* choice);
/* Quality: the reasons of the last choice, a few lines; else "". Lives until the next call with the controller. */
QUINCUNX_API const char* quincunx_controller_text(quincunx_controller* controller);
/* Errors: QUINCUNX_INVALID_ARGUMENT for one outside (0, 60000]; the old target then stays. */
QUINCUNX_API quincunx_status quincunx_controller_set_target_ms(quincunx_controller* controller,
                                                               double target_ms);
QUINCUNX_API double quincunx_controller_target_ms(const quincunx_controller* controller); /* 0 for NULL */
/* The ladder: extents from the smallest to the largest. Errors: QUINCUNX_INVALID_ARGUMENT for a number that is none. */
QUINCUNX_API int32_t quincunx_controller_rung_count(const quincunx_controller* controller); /* 0 for NULL */
QUINCUNX_API quincunx_status quincunx_controller_rung(const quincunx_controller* controller, int32_t rung,
                                                      int32_t extent[2]);

/* The mix of scene classes that such content is: shares that are 1 together. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_mix_of(const quincunx_content* content,
                                             double share[QUINCUNX_SCENE_CLASSES]);

/* Measured frame times by resolution, whose confidence decays: cost_table.h. `half_life_frames` lies in [1, 1e9].
 * `json`: what quincunx_costs_text() gave. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_costs_create(double half_life_frames, quincunx_costs** costs);
QUINCUNX_API quincunx_status quincunx_costs_parse(const char* json, quincunx_costs** costs);
QUINCUNX_API void quincunx_costs_destroy(quincunx_costs* costs);
/* `area_fraction`: pixels drawn over pixels of the output, in (0, 4]. `gpu_ms` lies in (0, 60000]. Frame numbers do not
 * fall. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_costs_record(quincunx_costs* costs, uint64_t frame,
                                                   double area_fraction, double gpu_ms);
QUINCUNX_API double quincunx_costs_confidence(const quincunx_costs* costs,
                                              double area_fraction); /* in [0, 1] */
/* The expected time, if `fixed_part` does not scale; and the part that does not, by what was recorded.
 * QUINCUNX_NOT_READY where too little was. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_costs_predict(const quincunx_costs* costs, double area_fraction,
                                                    double fixed_part, double* gpu_ms);
QUINCUNX_API quincunx_status quincunx_costs_fixed_part(const quincunx_costs* costs, double* fixed_part);
/* JSON. Lives until the next call with the costs. */
QUINCUNX_API const char* quincunx_costs_text(quincunx_costs* costs);

/* The error of each method's picture at each scale, and its cost: error_front.h. `json`: as quincunx_front_text()
 * gives it; NULL: the front that is built in. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_front_parse(const char* json, quincunx_front** front);
/* That of a device, measured or built in, for a scene's name; "" or NULL: any. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_front_find(const quincunx_device* device, const char* scene,
                                                 quincunx_front** front);
QUINCUNX_API void quincunx_front_destroy(quincunx_front* front);
/* JSON; and where it comes from, in a clause. Live as long as the front. */
QUINCUNX_API const char* quincunx_front_text(const quincunx_front* front);
QUINCUNX_API const char* quincunx_front_summary(const quincunx_front* front);
/* The expected mean FLIP of a mix; and the milliseconds of a method's passes for an output of so many megapixels.
 * `method`: a name of quincunx_variant_name(). Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_front_flip(const quincunx_front* front,
                                                 const double share[QUINCUNX_SCENE_CLASSES],
                                                 const char* method, double scale, double* flip);
QUINCUNX_API quincunx_status quincunx_front_resolve_ms(const quincunx_front* front, const char* method,
                                                       double scale, double output_megapixels, double* ms);

/* An output that follows the render extent, for inputs.output_*: output_follower.h. */
typedef struct quincunx_output_settings {
  size_t struct_size;    /* sizeof(quincunx_output_settings) */
  int32_t display_width; /* the largest output, pixels, each in [1, 32768]; no default */
  int32_t display_height;
  int32_t steps;       /* at most so many for each axis, at least 1; default 8 */
  int32_t rest_frames; /* between two changes, at least 0; default 30 */
  double min_scale;    /* smallest output of the display, per axis; in (0, 1]; default 0.5 */
  double max_filled;   /* of the output's area by the viewport's, in (0, 1]; default 0.64 */
  double
      hysteresis; /* fraction of the render area that is lost before the output falls; in [0, 1); default 0.15 */
} quincunx_output_settings;

QUINCUNX_API quincunx_status quincunx_output_settings_init(quincunx_output_settings* settings);
QUINCUNX_API quincunx_status quincunx_output_follower_create(const quincunx_output_settings* settings,
                                                             quincunx_output_follower** follower);
QUINCUNX_API void quincunx_output_follower_destroy(quincunx_output_follower* follower);
/* Called once per frame with the extent it is drawn at; gives the output that goes with it. An empty extent changes
 * nothing. min_output gives the smallest there may be, for settings.min_output_*. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_output_follower_observe(quincunx_output_follower* follower,
                                                              int32_t render_width, int32_t render_height,
                                                              int32_t output[2]);
QUINCUNX_API quincunx_status quincunx_output_follower_min_output(const quincunx_output_follower* follower,
                                                                 int32_t output[2]);

/* Detail that follows the resolution: detail_follower.h. */
typedef struct quincunx_detail_settings {
  size_t struct_size;  /* sizeof(quincunx_detail_settings) */
  int32_t levels;      /* in [2, 64]; 0 is the full detail, levels - 1 the least; default 4 */
  int32_t rest_frames; /* at least, between two changes; at least 0; default 30 */
  double full_area;    /* area fraction from which detail is full; default 0.8 */
  double min_area;     /* to which it falls to the least; in (0, full_area); default 0.3 */
  double hysteresis;   /* part of a level that has to be passed before it is left; in [0, 1]; default 0.25 */
} quincunx_detail_settings;

QUINCUNX_API quincunx_status quincunx_detail_settings_init(quincunx_detail_settings* settings);
QUINCUNX_API quincunx_status quincunx_detail_follower_create(const quincunx_detail_settings* settings,
                                                             quincunx_detail_follower** follower);
QUINCUNX_API void quincunx_detail_follower_destroy(quincunx_detail_follower* follower);
/* Called once per frame with the area fraction it is drawn at; gives the level. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_detail_follower_observe(quincunx_detail_follower* follower,
                                                              double area_fraction, int32_t* level);

#ifdef __cplusplus
}
#endif

#endif
