// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

using kernel::file::testing::OwnFolder;
using testing::HasSubstr;

std::string value(const IniFile& ini, const char* section, const char* key) {
  const IniEntry* const entry = ini.find(section, key);
  return entry == nullptr ? "(none)" : entry->value;
}

// What `inivar` of LinuxCNC 2.9 prints for this text.
TEST(IniFile, ReadsAsLinuxCncDoes) {
  const auto ini = IniFile::parse(
      "[A]\nX = 1 # c\nX=2\n Y= a \\\nb\n; Z = 3\nno assignment\n[B]\nQ=1\n[A]\nW=5\n[C] # "
      "foo\nV=3\n",
      "t.ini");
  ASSERT_TRUE(ini);
  EXPECT_EQ(value(*ini, "A", "X"), "1 # c");
  EXPECT_EQ(value(*ini, "A", "Y"), "a b");
  EXPECT_EQ(value(*ini, "A", "Z"), "(none)");
  EXPECT_EQ(value(*ini, "A", "W"), "(none)") << "the second section of a name";
  EXPECT_EQ(value(*ini, "A", "x"), "(none)");
  EXPECT_EQ(value(*ini, "C", "V"), "3");
  ASSERT_EQ(ini->all("A", "X").size(), 2U);
  EXPECT_EQ(ini->all("A", "X")[1]->line, 3U);
  EXPECT_EQ(ini->find("A", "Y")->line, 4U);
  EXPECT_EQ(ini->find("A", "Y")->top_line, 5U);
  EXPECT_EQ(ini->number("A", "X")->value().value, 1.0);
}

TEST(IniFile, KnowsInWhichSectionAnInsertedLineWouldBe) {
  const auto ini = IniFile::parse("# head\n[A]\nX=1\n\n[B]\n[A]\n", "t.ini");
  ASSERT_TRUE(ini);
  EXPECT_FALSE(ini->in_section_after(1, "A"));
  EXPECT_TRUE(ini->in_section_after(2, "A"));
  EXPECT_TRUE(ini->in_section_after(4, "A"));
  EXPECT_TRUE(ini->in_section_after(5, "B"));
  EXPECT_FALSE(ini->in_section_after(6, "A")) << "LinuxCNC does not read it";
  EXPECT_EQ(ini->section_line("B"), 5U);
  EXPECT_EQ(ini->section_line("C"), 0U);
}

TEST(IniFile, TakesInIncludedFilesOneLevelDeep) {
  const OwnFolder folder;
  folder.file("hal.inc", "[HAL]\nHALFILE = a.hal\n#INCLUDE deeper.inc\n");
  const auto ini =
      IniFile::read(folder.file("m.ini", "[EMC]\n#INCLUDE hal.inc\nHALFILE = b.hal\n"));
  ASSERT_TRUE(ini) << ini.error().what;
  const auto files = ini->all("HAL", "HALFILE");
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0]->value, "a.hal");
  EXPECT_EQ(files[0]->file, folder.at("hal.inc"));
  EXPECT_EQ(files[0]->line, 2U);
  EXPECT_EQ(files[0]->top_line, 2U);
  EXPECT_EQ(files[1]->line, 3U);
  EXPECT_THAT(ini->included(), testing::ElementsAre(folder.at("hal.inc")));
}

void expect_refused(const std::string& text, std::size_t line, const char* what) {
  const auto ini = IniFile::parse(text, "t.ini");
  ASSERT_FALSE(ini) << text;
  EXPECT_EQ(ini.error().line, line);
  EXPECT_THAT(ini.error().what, HasSubstr(what));
}

TEST(IniFile, RefusesWhatIsNoIniFile) {
  expect_refused("", 1, "no line is a [SECTION]");
  expect_refused("G21 G90\nG1 X10 F100\n", 1, "no line is a [SECTION]");
  expect_refused("[A]\n#INCLUDE\n", 2, "needs one file name");
  expect_refused("[A]\n\n#INCLUDE none.inc\n", 3, "cannot be read");
  const OwnFolder folder;
  const auto binary = IniFile::read(folder.file("b.ini", std::string("[A]\nX=\0\1", 8)));
  ASSERT_FALSE(binary);
  EXPECT_THAT(binary.error().what, HasSubstr("binary"));
  EXPECT_FALSE(IniFile::read(folder.at("none.ini")));
  EXPECT_FALSE(IniFile::read(folder.path().string()));
}

TEST(IniFile, RefusesNumbersThatAreNone) {
  const auto ini = IniFile::parse(
      "[A]\nGOOD = -1.5e2 ; note\nPLUS = +3\nWORD = fast\nTAIL = 1.5mm\nHEX = 0x10\nINF = "
      "inf\nNONE =\n",
      "t.ini");
  ASSERT_TRUE(ini);
  EXPECT_EQ(ini->number("A", "GOOD")->value().value, -150.0);
  EXPECT_EQ(ini->number("A", "PLUS")->value().value, 3.0);
  EXPECT_FALSE(ini->number("A", "MISSING")->has_value());
  std::size_t line = 4;
  for (const char* key : {"WORD", "TAIL", "HEX", "INF", "NONE"}) {
    const auto number = ini->number("A", key);
    ASSERT_FALSE(number) << key;
    EXPECT_EQ(number.error().line, line++) << key;
    EXPECT_THAT(number.error().what, HasSubstr("is not a number")) << key;
  }
}

}  // namespace
}  // namespace steadyrest::adapters::linuxcnc::config
