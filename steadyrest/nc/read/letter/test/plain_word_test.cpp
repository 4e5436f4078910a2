// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/nc/read/reader.hpp>

namespace steadyrest::nc::read {
namespace {

/// A word as a program has it, and what it means.
struct WrittenWord {
  char letter = 0;
  std::string number;
  std::string text;  ///< with the blanks between letter and number
};

WrittenWord any_word() {
  WrittenWord word;
  word.letter = *rc::gen::elementOf(std::string("ABCDEFGHIJKLMPQRSTUVWXYZ"));
  const auto digits = [](int least) {
    std::string out;
    for (int i = *rc::gen::inRange(least, 10); i > 0; --i) {
      out += static_cast<char>('0' + *rc::gen::inRange(0, 10));
    }
    return out;
  };
  word.number = *rc::gen::element<std::string>("", "-", "+") + digits(1) +
                *rc::gen::element<std::string>("", ".", "." + digits(0));
  const bool small = *rc::gen::arbitrary<bool>();
  word.text = static_cast<char>(small ? word.letter + ('a' - 'A') : word.letter) +
              *rc::gen::element<std::string>("", "", " ", "\t ") + word.number;
  return word;
}

// RS274/NGC: a word is a letter and a real value; case and blanks around it mean nothing. The
// dialects read such words by two ways, so both are compared with what was written.
TEST(PlainWord, IsTheLetterAndTheNumberThatWereWritten) {
  EXPECT_TRUE(rc::check([] {
    std::vector<WrittenWord> written;
    std::string line = *rc::gen::element<std::string>("", " ", "N10 ");
    for (int i = *rc::gen::inRange(1, 10); i > 0; --i) {
      written.push_back(any_word());
      line += written.back().text + *rc::gen::element<std::string>("", " ", "\t");
    }
    for (const Dialect dialect : {Dialect::linuxcnc, Dialect::fanuc}) {
      Reader reader(dialect);
      Block block;
      RC_ASSERT(reader.read(line, 1, 1, block));
      RC_ASSERT(block.words().size() == written.size());
      for (std::size_t i = 0; i < written.size(); ++i) {
        const Word& word = block.words()[i];
        const double value = std::strtod(written[i].number.c_str(), nullptr);
        RC_ASSERT(word.letter == written[i].letter);
        RC_ASSERT(std::bit_cast<std::uint64_t>(word.value) == std::bit_cast<std::uint64_t>(value));
        RC_ASSERT(word.decimal_point == (written[i].number.find('.') != std::string::npos));
        RC_ASSERT(word.has_value && !word.calculated && word.qualifier == Qualifier::none);
        RC_ASSERT(word.text == written[i].text);
      }
    }
  }));
}

// A second reader may take such a line over as it is; one with a parameter it must read itself.
TEST(PlainWord, IsANumberAlone) {
  Reader reader(Dialect::linuxcnc);
  Block block;
  ASSERT_TRUE(reader.read("G1 X1.5 (to the edge) Y2", 1, 1, block));
  EXPECT_TRUE(reader.numbers_alone());
  EXPECT_FALSE(reader.read("G1 X#5", 2, 1, block));
  EXPECT_FALSE(reader.numbers_alone());
}

}  // namespace
}  // namespace steadyrest::nc::read
