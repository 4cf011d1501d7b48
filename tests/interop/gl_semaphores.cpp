// SPDX-License-Identifier: MIT
#include "gl_semaphores.h"

#include <epoxy/gl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <map>

#include "real_function.h"

namespace quincunx::gl::testing {
namespace {

// Loaded before anyone asks for Vulkan's loader by its name, which this library has, too.
#ifdef QUINCUNX_PRETEND_VULKAN
void* const g_loader = dlopen(QUINCUNX_PRETEND_VULKAN, RTLD_NOW | RTLD_LOCAL);
#else
void* const g_loader = nullptr;
#endif

bool g_pretends = false;
PretendSemaphores::Flaw g_flaw = PretendSemaphores::Flaw::kNone;
std::map<GLuint, int> g_semaphores;
GLuint g_next = 1;
int g_uses = 0;
std::atomic<int> g_faults = 0;

void APIENTRY gen(GLsizei count, GLuint* to) {
  for (GLsizei i = 0; i < count; ++i) {
    to[i] = g_next++;
    g_semaphores[to[i]] = -1;
  }
}
void APIENTRY remove(GLsizei count, const GLuint* names) {
  for (GLsizei i = 0; i < count; ++i) {
    if (g_semaphores[names[i]] >= 0) close(g_semaphores[names[i]]);
    g_semaphores.erase(names[i]);
  }
}
void APIENTRY import(GLuint name, GLenum, GLint fd) {
  g_semaphores.at(name) = fd;
}
void APIENTRY signal(GLuint name, GLuint, const GLuint*, GLuint, const GLuint*, const GLenum*) {
  ++g_uses;
  glFinish();
  if (g_flaw != PretendSemaphores::Flaw::kNeverSignalled) signal_event(g_semaphores.at(name));
}
void APIENTRY wait(GLuint name, GLuint, const GLuint*, GLuint, const GLuint*, const GLenum*) {
  constexpr int kLongestMs = 10'000;
  ++g_uses;
  pollfd ready = {.fd = g_semaphores.at(name), .events = POLLIN, .revents = 0};
  std::uint64_t value = 0;
  if (poll(&ready, 1, kLongestMs) != 1 || read(ready.fd, &value, sizeof(value)) != sizeof(value)) ++g_faults;
}

struct Functions {
  decltype(epoxy_glGenSemaphoresEXT) gen = testing::gen;
  decltype(epoxy_glDeleteSemaphoresEXT) remove = testing::remove;
  decltype(epoxy_glImportSemaphoreFdEXT) import = testing::import;
  decltype(epoxy_glSignalSemaphoreEXT) signal = testing::signal;
  decltype(epoxy_glWaitSemaphoreEXT) wait = testing::wait;
};
Functions g_others;

void exchange() {
  std::swap(epoxy_glGenSemaphoresEXT, g_others.gen);
  std::swap(epoxy_glDeleteSemaphoresEXT, g_others.remove);
  std::swap(epoxy_glImportSemaphoreFdEXT, g_others.import);
  std::swap(epoxy_glSignalSemaphoreEXT, g_others.signal);
  std::swap(epoxy_glWaitSemaphoreEXT, g_others.wait);
}

}  // namespace

PretendSemaphores::PretendSemaphores(Flaw flaw) {
  g_pretends = true;
  g_flaw = flaw;
  g_uses = 0;
  g_faults = 0;
  exchange();
}

PretendSemaphores::~PretendSemaphores() {
  g_pretends = false;
  exchange();
}

bool PretendSemaphores::works() {
  return g_loader != nullptr;
}

int PretendSemaphores::uses() const {
  return g_uses;
}

int PretendSemaphores::faults() const {
  return g_faults;
}

void signal_event(int fd) {
  pollfd ready = {.fd = fd, .events = POLLIN, .revents = 0};
  if (poll(&ready, 1, 0) != 0) ++g_faults;
  const std::uint64_t one = 1;
  if (write(fd, &one, sizeof(one)) != sizeof(one)) ++g_faults;
}

}  // namespace quincunx::gl::testing

extern "C" bool epoxy_has_gl_extension(const char* name) {
  if (quincunx::gl::testing::g_pretends && std::strcmp(name, "GL_EXT_semaphore_fd") == 0) return true;
  static const auto real = REAL(epoxy_has_gl_extension);
  return real(name);
}
