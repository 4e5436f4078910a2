// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "linuxcnc/linuxcnc_files.hpp"
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/adapters/linuxcnc/config/machine_text.hpp>
#include <steadyrest/adapters/linuxcnc/config/text_lines.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::test {
namespace {

namespace config = adapters::linuxcnc::config;

/// The lathe's INI file with lines dropped, doubled, swapped and values replaced.
std::string mutated() {
  auto lines = config::lines_of(inch_lathe());
  const int changes = *rc::gen::inRange(1, 5);
  for (int i = 0; i < changes; ++i) {
    const auto at = *rc::gen::inRange<std::size_t>(0, lines.size());
    switch (*rc::gen::inRange(0, 5)) {
      case 0:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 1:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), lines[at]);
        break;
      case 2:
        std::swap(lines[at], lines[*rc::gen::inRange<std::size_t>(0, lines.size())]);
        break;
      case 3: {
        const std::size_t character = *rc::gen::inRange<std::size_t>(0, lines[at].size());
        lines[at][character] = *rc::gen::arbitrary<char>();
        break;
      }
      default: {
        const std::size_t equals = lines[at].find('=');
        if (equals != std::string::npos) {
          lines[at] = lines[at].substr(0, equals) + "= " +
                      *rc::gen::element<std::string>("0", "-1", "1e99", "-1e99", "0.001", "7e5",
                                                     "1e-9", "100", "2000000", "nan", "9",
                                                     "XYZABCUV", "\xff\xfe", "#") +
                      "\n";
        }
        break;
      }
    }
  }
  std::string out;
  for (const std::string& line : lines) {
    out += line;
  }
  return out;
}

// Whatever an INI file says: what comes out is read back, or there is a refusal with a remedy.
TEST(AnyIniFile, GivesAMachineFileThatReadsBackOrARefusal) {
  int made = 0;
  EXPECT_TRUE(rc::check([&made] {
    const std::string text = mutated();
    const auto ini = config::IniFile::parse(text, "m.ini");
    const auto machine = ini ? config::configuration_of(*ini) : std::unexpected(ini.error());
    const auto out = machine ? config::machine_text(*ini, *machine, nullptr, {})
                             : std::unexpected(machine.error());
    if (!out) {
      RC_ASSERT(out.error().file == "m.ini");
      RC_ASSERT(!out.error().what.empty());
      RC_ASSERT(!out.error().to_do.empty());
      return;
    }
    ++made;
    const auto read = passport::parse(out->text, "m.toml");
    if (!read) {
      RC_FAIL(read.error().what + "\n" + text);
    }
  }));
  EXPECT_GT(made, 0);
}

}  // namespace
}  // namespace steadyrest::test
