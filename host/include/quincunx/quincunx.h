/* SPDX-License-Identifier: MIT */
/* quincunx.h: the library from C, and from every language that can call C. C99; needs no OpenCL headers.
 *
 *   quincunx_settings settings = {sizeof settings};
 *   quincunx_settings_init(&settings);                      then the fields that differ, output and target at least
 *   quincunx_plan_create(&settings, &plan);
 *   quincunx_device_open("", &device);
 *   quincunx_service_create(device, plan, &service);
 *   each frame: quincunx_dispatch(service, &inputs, &outputs, &report);
 *
 * Objects are made by *_create and *_open and end by *_destroy, in any order; NULL may be destroyed. Structs are the
 * caller's. Each begins with struct_size, which the caller sets to its sizeof; all else of a struct may be zero. A
 * later library appends fields and knows by the size which of them the caller has. So a program runs with every library
 * of the same SONAME whose quincunx_api_version() is at least the QUINCUNX_API_VERSION that it was compiled with.
 *
 * Errors: every function that can fail returns a code, and quincunx_last_error() has one sentence that says what is
 * wrong, where, and what would be right. After an error nothing has changed unless the function says otherwise.
 * Pointers to what a function makes are then NULL. No exception leaves the library.
 *
 * c/control.h has controllers that choose each frame's resolution and method.
 *
 * Threads: a device with its services belongs to one thread at a time. Plans may be read by several. */
#ifndef QUINCUNX_QUINCUNX_H
#define QUINCUNX_QUINCUNX_H

#include <stdint.h>

#include "quincunx/advanced/export.h"
#include "quincunx/c/frame.h"
#include "quincunx/c/settings.h"

#ifdef __cplusplus
extern "C" {
#endif

#define QUINCUNX_API_VERSION 2

typedef int32_t quincunx_status;
enum {
  QUINCUNX_OK = 0,
  QUINCUNX_INVALID_ARGUMENT = 1, /* can never work; the sentence names the field */
  QUINCUNX_UNSUPPORTED = 2,      /* valid, but this device, driver or build cannot do it */
  QUINCUNX_DEVICE_FAILURE = 3,   /* an OpenCL call failed */
  QUINCUNX_IO_FAILURE = 4,
  QUINCUNX_NOT_READY = 5, /* no error: there is nothing yet */
  QUINCUNX_OUT_OF_MEMORY = 6,
  QUINCUNX_INTERNAL = 7 /* an error in the library */
};

typedef struct quincunx_device quincunx_device;
typedef struct quincunx_plan quincunx_plan;
typedef struct quincunx_service quincunx_service;
typedef struct quincunx_memory quincunx_memory;
typedef struct quincunx_semaphore quincunx_semaphore;

QUINCUNX_API int32_t quincunx_api_version(void); /* of the library: QUINCUNX_API_VERSION when it was built */
QUINCUNX_API const char* quincunx_version(void); /* "0.1.0"; static */
/* Why the last call of this thread that failed did so; "" where none has. Valid until the next one that fails. */
QUINCUNX_API const char* quincunx_last_error(void);

/* Levels of the log's lines. */
enum { QUINCUNX_LOG_DEBUG = 0, QUINCUNX_LOG_INFO = 1, QUINCUNX_LOG_WARNING = 2, QUINCUNX_LOG_ERROR = 3 };
/* `message`: one line of UTF-8 without its end, valid until the function returns. */
typedef void (*quincunx_log_function)(int32_t level, const char* message, void* user);
/* As quincunx::set_log() of advanced/log.h, which says which thread calls: all lines of the process go to `function`,
 * with `user`; NULL: warnings and errors to stderr. At any time, from any thread. Errors: QUINCUNX_OUT_OF_MEMORY. */
QUINCUNX_API quincunx_status quincunx_set_log(quincunx_log_function function, void* user);

/* Sets every field to its default but struct_size, which it reads. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_settings_init(quincunx_settings* settings);

/* As quincunx::jitter(), jitter_phases() and texture_lod_bias() of frame.h, for QUINCUNX_TEMPORAL: where the samples of
 * a frame lie (to jitter[0] and [1], render pixels, +x right, +y down), how many places there are, and the LOD bias of
 * textures. Without jitter many frames show no more detail than one. */
QUINCUNX_API void quincunx_jitter(uint64_t frame_index, int32_t render_width, int32_t render_height,
                                  int32_t output_width, int32_t output_height, float jitter[2]);
QUINCUNX_API int32_t quincunx_jitter_phases(int32_t render_width, int32_t render_height, int32_t output_width,
                                            int32_t output_height);
QUINCUNX_API float quincunx_texture_lod_bias(int32_t render_width, int32_t render_height,
                                             int32_t output_width, int32_t output_height);

/* The methods' names, in the order of their numbers: 0 is "point". NULL for a number that is none. Static. */
QUINCUNX_API const char* quincunx_method_name(int32_t method);
/* Names of methods with the settings that change their picture and cost, "temporal:fast", in the order of growing
 * effort. NULL for a number that is none. Static. */
QUINCUNX_API const char* quincunx_variant_name(int32_t variant);
/* Sets the method and its form, sampling or preset by such a name; a method's name alone means its defaults. Errors:
 * QUINCUNX_INVALID_ARGUMENT for another name (the sentence lists them) and other bad fields. */
QUINCUNX_API quincunx_status quincunx_settings_set_method(quincunx_settings* settings, const char* name);

/* The passes and images that follow from the settings. Pure: needs no device. Errors: QUINCUNX_INVALID_ARGUMENT; the
 * sentence names every bad field. */
QUINCUNX_API quincunx_status quincunx_plan_create(const quincunx_settings* settings, quincunx_plan** plan);
QUINCUNX_API void quincunx_plan_destroy(quincunx_plan* plan);
/* Which inputs a frame must have. Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_plan_needs(const quincunx_plan* plan, quincunx_needs* needs);
/* A page of plain text: passes, images, bytes, and why. Lives as long as the plan; NULL for no plan. */
QUINCUNX_API const char* quincunx_plan_text(const quincunx_plan* plan);
/* The plan of the focus's region, of which inputs.focus->frame is a frame. Errors: QUINCUNX_INVALID_ARGUMENT where
 * there is none. */
QUINCUNX_API quincunx_status quincunx_plan_focus(const quincunx_plan* plan, quincunx_plan** region);
/* Whether a frame of this viewport and output (0, 0: the settings') reads earlier frames where there are any. */
QUINCUNX_API int32_t quincunx_plan_reads_history(const quincunx_plan* plan, int32_t render_width,
                                                 int32_t render_height, int32_t output_width,
                                                 int32_t output_height);

/* Opens an OpenCL device. `selector`: "" or NULL for the first one, GPUs before CPUs; "cpu" or "gpu"; a number; or a
 * part of "platform name". Errors: QUINCUNX_INVALID_ARGUMENT where nothing matches (the sentence lists the devices),
 * QUINCUNX_UNSUPPORTED without any device, QUINCUNX_DEVICE_FAILURE. */
QUINCUNX_API quincunx_status quincunx_device_open(const char* selector, quincunx_device** device);
/* Uses the caller's cl_context, cl_device_id and in-order cl_command_queue, all retained until the device and its
 * services are destroyed. Errors: as above. */
QUINCUNX_API quincunx_status quincunx_device_borrow(void* context, void* id, void* queue,
                                                    quincunx_device** device);
QUINCUNX_API void quincunx_device_destroy(quincunx_device* device);
QUINCUNX_API const char* quincunx_device_name(
    const quincunx_device* device); /* lives as long as the device */
/* Its profile, "tuned 2026-11-22 21:05 UTC", and the clock that times its passes, "OpenCL event"; as above. */
QUINCUNX_API const char* quincunx_device_profile(const quincunx_device* device);
QUINCUNX_API const char* quincunx_device_pass_timer(const quincunx_device* device);
/* Its cl_context, cl_device_id and cl_command_queue, to make memory objects with. Not retained; NULL for no device. */
QUINCUNX_API void* quincunx_device_context(const quincunx_device* device);
QUINCUNX_API void* quincunx_device_id(const quincunx_device* device);
QUINCUNX_API void* quincunx_device_queue(const quincunx_device* device);

/* Its UUID; all 0: not known. */
QUINCUNX_API void quincunx_device_uuid(const quincunx_device* device, uint8_t uuid[16]);

/* Memory and binary semaphores of another API, as SharedMemory and Semaphore of advanced/external.h have them. They may
 * be destroyed when the work that uses them is done. Errors: QUINCUNX_INVALID_ARGUMENT for a bad field and for memory
 * of another device, QUINCUNX_UNSUPPORTED if the device cannot import such a handle, QUINCUNX_DEVICE_FAILURE. */
enum quincunx_handle { QUINCUNX_OPAQUE_FD = 0, QUINCUNX_DMA_BUF = 1, QUINCUNX_MAPPED = 2 };
QUINCUNX_API quincunx_status quincunx_memory_import(const quincunx_device* device,
                                                    const quincunx_external_memory* external,
                                                    quincunx_memory** memory);
QUINCUNX_API void quincunx_memory_destroy(quincunx_memory* memory);
QUINCUNX_API void* quincunx_memory_object(const quincunx_memory* memory); /* a cl_mem, not retained */
/* The other API owns the memory first. Each call enqueues a change of owner. `done`, if not NULL, receives a cl_event
 * of that, which the caller releases; NULL if nothing had to change. */
QUINCUNX_API quincunx_status quincunx_memory_acquire(quincunx_memory* memory);
QUINCUNX_API quincunx_status quincunx_memory_release(quincunx_memory* memory, void** done);
QUINCUNX_API quincunx_status quincunx_semaphore_import(const quincunx_device* device, int32_t fd,
                                                       quincunx_semaphore** semaphore);
QUINCUNX_API void quincunx_semaphore_destroy(quincunx_semaphore* semaphore);
QUINCUNX_API quincunx_status quincunx_semaphore_wait(quincunx_semaphore* semaphore);
QUINCUNX_API quincunx_status quincunx_semaphore_signal(quincunx_semaphore* semaphore);

/* Compiles or loads the plan's kernels and allocates. Device and plan may be destroyed after it. Errors:
 * QUINCUNX_UNSUPPORTED where the device lacks what the plan needs, QUINCUNX_DEVICE_FAILURE. */
QUINCUNX_API quincunx_status quincunx_service_create(const quincunx_device* device, const quincunx_plan* plan,
                                                     quincunx_service** service);
QUINCUNX_API void quincunx_service_destroy(quincunx_service* service); /* waits for its frames */

/* Whether a frame fits the plan. Pure: needs no device and reads no pixel. Errors: QUINCUNX_INVALID_ARGUMENT; the
 * sentence names every bad field. */
QUINCUNX_API quincunx_status quincunx_validate(const quincunx_plan* plan, const quincunx_inputs* inputs,
                                               const quincunx_outputs* outputs);

/* Resolves one frame. `report` may be NULL; its times are not known yet. Memory objects: the passes are enqueued, and
 * nothing is waited for; c/frame.h says how long inputs must stay. Host memory: inputs have been read when it returns,
 * and where an output is one, the frame has been waited for and the picture lies there. A bad frame is refused whole:
 * no output is touched, and the history is as it was. Errors: QUINCUNX_INVALID_ARGUMENT; QUINCUNX_DEVICE_FAILURE, after
 * which the frame may have been resolved, and the next one should set reset. */
QUINCUNX_API quincunx_status quincunx_dispatch(quincunx_service* service, const quincunx_inputs* inputs,
                                               const quincunx_outputs* outputs, quincunx_report* report);

/* The oldest finished frame whose report was not taken yet, with its times. Never waits. QUINCUNX_NOT_READY where none
 * has finished; reports of the last 64 frames are kept. */
QUINCUNX_API quincunx_status quincunx_next_report(quincunx_service* service, quincunx_report* report);

/* Where pass_timer is "host clock", lets quincunx_dispatch() wait for each pass, which is then timed; off at first.
 * Errors: QUINCUNX_INVALID_ARGUMENT. */
QUINCUNX_API quincunx_status quincunx_allow_timing_waits(quincunx_service* service, int32_t allow);

/* Fills the top left part of a memory object with one value, where settings.clear announced it. Enqueued like a frame.
 * Errors: QUINCUNX_INVALID_ARGUMENT, QUINCUNX_DEVICE_FAILURE. */
QUINCUNX_API quincunx_status quincunx_clear(quincunx_service* service, const quincunx_image* image,
                                            int32_t width, int32_t height, const float value[4]);

/* Waits until every frame is done. Errors: QUINCUNX_DEVICE_FAILURE. */
QUINCUNX_API quincunx_status quincunx_finish(quincunx_service* service);

#ifdef __cplusplus
}
#endif

#endif
