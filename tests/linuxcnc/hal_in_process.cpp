// SPDX-License-Identifier: Apache-2.0
// The C functions that components link against, reduced to what they need in one thread; signatures
// are those of LinuxCNC's public hal.h.
#include "hal_in_process.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace steadyrest::test::linuxcnc {

Hal& hal() {
  static Hal instance;
  return instance;
}

namespace {

std::string formatted(const char* format, va_list arguments) {
  char text[256];
  std::vsnprintf(text, sizeof text, format, arguments);
  return text;
}

}  // namespace
}  // namespace steadyrest::test::linuxcnc

using steadyrest::test::linuxcnc::formatted;
using steadyrest::test::linuxcnc::hal;

extern "C" {

int hal_init(const char* /*name*/) {
  return 1;
}
int hal_exit(int /*component*/) {
  return 0;
}
int hal_ready(int /*component*/) {
  return 0;
}
/// Pins live as long as the process, like HAL's shared memory.
void* hal_malloc(long size) {
  return std::calloc(1, static_cast<std::size_t>(size));
}

int hal_export_funct(const char* name, void (*function)(void*, long), void* argument,
                     int /*uses_fp*/, int /*reentrant*/, int /*component*/) {
  hal().add(name, {function, argument});
  return 0;
}

/// Components name pins by a format; the name is the only way to find a pin here.
int hal_pin_bit_newf(int /*direction*/, bool** pin, int /*component*/, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  hal().add(formatted(format, arguments), pin);
  va_end(arguments);
  return 0;
}

int hal_pin_float_newf(int /*direction*/, double** pin, int /*component*/, const char* format,
                       ...) {
  va_list arguments;
  va_start(arguments, format);
  hal().add(formatted(format, arguments), pin);
  va_end(arguments);
  return 0;
}

int hal_pin_s32_newf(int /*direction*/, std::int32_t** pin, int /*component*/, const char* format,
                     ...) {
  va_list arguments;
  va_start(arguments, format);
  hal().add(formatted(format, arguments), pin);
  va_end(arguments);
  return 0;
}

int hal_param_bit_newf(int /*direction*/, bool* parameter, int /*component*/, const char* format,
                       ...) {
  va_list arguments;
  va_start(arguments, format);
  hal().add_parameter(formatted(format, arguments), parameter);
  va_end(arguments);
  return 0;
}

int hal_param_float_newf(int /*direction*/, double* parameter, int /*component*/,
                         const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  hal().add_parameter(formatted(format, arguments), parameter);
  va_end(arguments);
  return 0;
}

int rtapi_get_msg_level() {
  return 0;
}
int rtapi_set_msg_level(int /*level*/) {
  return 0;
}
/// Silence: the component reports its start on stderr, which the tests compare.
void rtapi_print_msg(int /*level*/, const char* /*format*/, ...) {}

int rtapi_snprintf(char* text, unsigned long size, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int length = std::vsnprintf(text, size, format, arguments);
  va_end(arguments);
  return length;
}

}  // extern "C"
