// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdint>
#include <vector>

#include <comedilib.h>
#include <gpiod.h>

#include <steadyrest/adapters/lines/testing/fake_cards.hpp>

using steadyrest::adapters::lines::testing::fake_cards;

namespace steadyrest::adapters::lines::testing {

FakeCards& fake_cards() {
  static FakeCards cards;
  return cards;
}

}  // namespace steadyrest::adapters::lines::testing

// A line's or card's pointer only has to be told from null: its number, and one more.
namespace {

template <class T>
T* as_pointer(unsigned number) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): nothing is behind it
  return reinterpret_cast<T*>(static_cast<std::uintptr_t>(number) + 1);
}
template <class T>
unsigned as_number(T* pointer) {
  return static_cast<unsigned>(reinterpret_cast<std::uintptr_t>(pointer) - 1);
}

int take(gpiod_line_bulk* bulk, int direction, const int* levels) {
  auto& cards = fake_cards();
  for (unsigned i = 0; i < bulk->num_lines; ++i) {
    const unsigned line = as_number(bulk->lines[i]);
    if (cards.direction[line] == -1) {
      errno = EBUSY;
      return -1;
    }
    cards.direction[line] = direction;
    if (levels != nullptr) {
      cards.level[line] = levels[i];
    }
  }
  return 0;
}

}  // namespace

extern "C" {

gpiod_chip* gpiod_chip_open_lookup(const char* name) {
  if (fake_cards().chip != name) {
    errno = ENOENT;
    return nullptr;
  }
  return as_pointer<gpiod_chip>(0);
}
void gpiod_chip_close(gpiod_chip* /*chip*/) {}
int gpiod_chip_get_lines(gpiod_chip* /*chip*/, unsigned* offsets, unsigned count,
                         gpiod_line_bulk* bulk) {
  bulk->num_lines = count;
  for (unsigned i = 0; i < count; ++i) {
    if (offsets[i] >= fake_cards().lines) {
      errno = EINVAL;
      return -1;
    }
    bulk->lines[i] = as_pointer<gpiod_line>(offsets[i]);
  }
  return 0;
}
int gpiod_line_request_bulk_input(gpiod_line_bulk* bulk, const char* /*consumer*/) {
  return take(bulk, 1, nullptr);
}
int gpiod_line_request_bulk(gpiod_line_bulk* bulk, const gpiod_line_request_config* config,
                            const int* levels) {
  return take(bulk, config->request_type == GPIOD_LINE_REQUEST_DIRECTION_AS_IS ? 3 : 2, levels);
}
int gpiod_line_set_direction_output_bulk(gpiod_line_bulk* bulk, const int* values) {
  errno = EIO;
  return fake_cards().fails ? -1 : take(bulk, 2, values);
}
void gpiod_line_release_bulk(gpiod_line_bulk* bulk) {
  fake_cards().released += bulk->num_lines;
}
int gpiod_line_get_value_bulk(gpiod_line_bulk* bulk, int* values) {
  for (unsigned i = 0; i < bulk->num_lines; ++i) {
    values[i] = fake_cards().level[as_number(bulk->lines[i])];
  }
  errno = EIO;
  return fake_cards().fails ? -1 : 0;
}
int gpiod_line_set_value_bulk(gpiod_line_bulk* bulk, const int* values) {
  for (unsigned i = 0; i < bulk->num_lines; ++i) {
    fake_cards().level[as_number(bulk->lines[i])] = values[i];
  }
  errno = EIO;
  return fake_cards().fails ? -1 : 0;
}

comedi_t* comedi_open(const char* name) {
  return fake_cards().card == name ? as_pointer<comedi_t>(0) : nullptr;
}
int comedi_close(comedi_t* /*card*/) {
  return 0;
}
int comedi_errno() {
  return EIO;
}
const char* comedi_strerror(int /*fault*/) {
  return "as the fake says";
}
int comedi_get_n_channels(comedi_t* /*card*/, unsigned subdevice) {
  return subdevice > 1 ? -1 : static_cast<int>(fake_cards().lines);
}
int comedi_get_subdevice_type(comedi_t* /*card*/, unsigned subdevice) {
  const bool fixed = fake_cards().fixed_direction;
  return !fixed ? COMEDI_SUBD_DIO : subdevice == 0 ? COMEDI_SUBD_DI : COMEDI_SUBD_DO;
}
int comedi_dio_config(comedi_t* /*card*/, unsigned subdevice, unsigned line, unsigned direction) {
  fake_cards().turned[{subdevice, line}] = direction;
  return 0;
}
int comedi_dio_bitfield2(comedi_t* /*card*/, unsigned subdevice, unsigned mask, unsigned* bits,
                         unsigned base) {
  unsigned& all = fake_cards().bits[subdevice];
  all = (all & ~(mask << base)) | ((*bits & mask) << base);
  *bits = all >> base;
  return fake_cards().fails ? -1 : 0;
}
}
