// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

/// A GPIO chip and a comedi card below libgpiod's and comedilib's own functions, which a test links
/// in their place (fake_cards.cpp).
namespace steadyrest::adapters::lines::testing {

struct FakeCards {
  std::string chip;               ///< name of the chip that exists
  unsigned lines = 32;            ///< of the chip, and of each subdevice
  std::map<unsigned, int> level;  ///< of a GPIO line
  std::map<unsigned, int>
      direction;  ///< −1: another program has it; 1 input, 2 output, 3 as it was
  unsigned released = 0;
  bool fails = false;            ///< whatever is asked for
  bool fixed_direction = false;  ///< comedi: subdevice 0 is inputs alone, 1 outputs

  std::string card;
  std::map<unsigned, unsigned> bits;                         ///< levels of a comedi subdevice
  std::map<std::pair<unsigned, unsigned>, unsigned> turned;  ///< direction of its lines
};

[[nodiscard]] FakeCards& fake_cards();

}  // namespace steadyrest::adapters::lines::testing
