// SPDX-License-Identifier: Apache-2.0
// The control's texts go into a folder that may hold others.
#include <fstream>
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace steadyrest::test {
namespace {

using ::testing::HasSubstr;

class Texts : public ::testing::Test {
 protected:
  std::string texts(const std::string& machine) const {
    return "opcua texts --machine " + machine + " -o " + scratch_.at("control");
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return scratch_.at("control") + "/" + name;
  }

  Scratch scratch_;
  std::string machine_ = project_file("examples/machines/vmc-840d-opcua.toml");
};

TEST_F(Texts, AFileOfTheMachinesOwnIsRefused) {
  ASSERT_EQ(run_line(texts(machine_)).code, 0);
  std::ofstream(file("PROG_EVENT.SPF")) << "; the machine's own\nRET\n";
  expect_refused(texts(machine_), "PROG_EVENT.SPF: is there already, and is not of this program");
  EXPECT_EQ(text_of_file(file("PROG_EVENT.SPF")), "; the machine's own\nRET\n");
}

TEST_F(Texts, ATextThatSomebodyHasChangedIsKeptBeside) {
  ASSERT_EQ(run_line(texts(machine_)).code, 0);
  const std::string shipped = text_of_file(file("PROG_EVENT.SPF"));
  std::ofstream(file("PROG_EVENT.SPF")) << shipped << "; and the door's call\n";
  const Finished again = run_line(texts(machine_));
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("PROG_EVENT.SPF.old now"));
  EXPECT_EQ(text_of_file(file("PROG_EVENT.SPF")), shipped);
  EXPECT_EQ(text_of_file(file("PROG_EVENT.SPF.old")), shipped + "; and the door's call\n");
}

TEST_F(Texts, APlcBlockOfAnotherMappingIsRefused) {
  std::string text = text_of_file(machine_);
  const auto put = [&text](const std::string& was, const std::string& becomes) {
    ASSERT_NE(text.find(was), std::string::npos) << was;
    text.replace(text.find(was), was.size(), becomes);
  };
  const std::string mapping = "mapping = \"../opcua/sinumerik-840d-sl.toml\"";
  put(mapping, "mapping = \"" + project_file("examples/opcua/sinumerik-plc.toml") + "\"");
  ASSERT_EQ(run_line(texts(scratch_.file("plc.toml", text))).code, 0);
  expect_refused(texts(machine_), "STEADYREST.SCL: is of another mapping");
}

}  // namespace
}  // namespace steadyrest::test
