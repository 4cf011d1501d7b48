// SPDX-License-Identifier: MIT
// For builds with AddressSanitizer: Mesa's driver keeps memory in its own statics, and is unloaded with the
// last context. What only they point to then looks like a leak of a module without a name, which no
// suppression can match. So nothing is unloaded; real leaks are still seen.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define QUINCUNX_KEEP_MODULES
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define QUINCUNX_KEEP_MODULES
#endif

#if defined(QUINCUNX_KEEP_MODULES)
extern "C" __attribute__((visibility("default"))) int dlclose(void*) noexcept {
  return 0;
}
#endif
