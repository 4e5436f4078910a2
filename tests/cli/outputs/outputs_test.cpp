// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "help.hpp"
#include "output_folder.hpp"
#include "output_rows.hpp"
#include "process.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace steadyrest::test {

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Key;
using testing::UnorderedElementsAreArray;

/// Old results of the same kind that differ from the new ones by a line end.
Texts older(const Texts& results) {
  Texts out = results;
  for (auto& [name, text] : out) {
    text += "\n";
  }
  return out;
}

class Outputs : public testing::TestWithParam<OutputRow> {
 protected:
  OutputFolder folder_{GetParam()};
  const Texts examples_ = folder_.examples();

  int run(const std::vector<std::string>& command, Process::Limits limits = {}) {
    Process process(command, folder_.path(), limits);
    const int code = process.wait();
    err_ = process.err();
    return code;
  }
  /// The files are there even if nobody reads the summary.
  Texts made_for_nobody() {
    EXPECT_EQ(run(folder_.command(), {.out = Process::Stdout::closed_pipe}), 1);
    EXPECT_THAT(err_, HasSubstr("failed to write the answer to stdout"));
    Texts results = folder_.results();
    std::vector<testing::Matcher<const Texts::value_type&>> keys;
    for (const std::string& name : folder_.outputs()) {
      keys.emplace_back(Key(name));
    }
    EXPECT_THAT(results, UnorderedElementsAreArray(keys));
    return results;
  }
  void expect_none_fits(long bytes, const Texts& old) {
    folder_.place(old);
    EXPECT_EQ(run(folder_.command(), {.largest_file = bytes}), 1) << bytes;
    EXPECT_THAT(err_, HasSubstr("write failed: File too large")) << bytes;
    EXPECT_EQ(folder_.results(), old) << bytes;
  }
  std::string err_;
};

long half_of_largest(const Texts& results) {
  std::size_t largest = 0;
  for (const auto& [name, text] : results) {
    largest = std::max(largest, text.size());
  }
  return static_cast<long>(largest / 2);
}

/// OUT and DIR in a verb's help are the outputs that exist.
std::set<std::string> output_flags(const std::string& help) {
  static const std::regex kOutput(R"((--[a-z-]+) (OUT|DIR)\b)");
  std::set<std::string> out;
  for (std::sregex_iterator at(help.begin(), help.end(), kOutput), end; at != end; ++at) {
    out.insert((*at)[1]);
  }
  return out;
}

// Help and table must agree, so a new output cannot escape these tests.
TEST(OutputTable, HasEveryOutputOfEveryVerb) {
  std::set<std::pair<std::string, std::string>> in_help;
  for (const Words& verb : verbs()) {
    for (const std::string& flag : output_flags(help_of(verb))) {
      in_help.emplace(joined(verb), flag);
    }
  }
  std::set<std::pair<std::string, std::string>> in_table;
  for (const OutputRow& row : output_rows()) {
    for (const OutputOption& option : row.outputs) {
      in_table.emplace(row.verb, option.flag);
    }
  }
  EXPECT_EQ(in_help, in_table);
}

// By name, by another spelling of the path, by symbolic and by hard link.
TEST_P(Outputs, ThatAreAnInputAreRefused) {
  const auto refused = [this](const std::vector<std::string>& command, const std::string& how) {
    EXPECT_EQ(run(command), 2) << how;
    EXPECT_THAT(err_, HasSubstr("--force")) << how;
    EXPECT_EQ(folder_.examples(), examples_) << how;
  };
  for (const std::string& input : GetParam().inputs) {
    for (const OutputOption& option : GetParam().outputs) {
      if (option.files.front() == option.value) {
        refused(folder_.command({{option.flag, input}}), option.flag + " " + input);
        refused(folder_.command({{option.flag, "./examples/../" + input}}), option.flag);
      }
    }
    for (const std::string& output : folder_.outputs()) {
      for (const bool hard : {false, true}) {
        folder_.clear();
        const fs::path link = folder_.at(output);
        fs::create_directories(link.parent_path());
        hard ? fs::create_hard_link(folder_.at(input), link)
             : fs::create_symlink(folder_.at(input), link);
        refused(folder_.command(), output + (hard ? " is " : " leads to ") + input);
      }
    }
  }
}

// A note, a log, a process file, JSON and a page that are not ours: each kind looks a little like a
// result.
TEST_P(Outputs, ReplaceNothingOfAnotherKindWithoutForce) {
  for (const std::string& output : folder_.outputs()) {
    for (const std::string precious :
         {"a note of mine\n", "t_s,count\n0,0\n", "[cut]\noperation = \"milling\"\n",
          "{\"mine\": 1}\n", "<!doctype html>\n<title>Mine</title>\n"}) {
      folder_.place({{output, precious}});
      EXPECT_EQ(run(folder_.command()), 2) << output;
      EXPECT_THAT(err_, HasSubstr("exists and is not")) << output;
      EXPECT_EQ(folder_.results(), (Texts{{output, precious}})) << output;
    }
  }
  std::vector<std::string> forced = folder_.command();
  forced.emplace_back("--force");
  EXPECT_EQ(run(forced), 0) << err_;
  EXPECT_EQ(folder_.results().size(), folder_.outputs().size());
}

// One test, because each verb's whole work takes seconds under the sanitizers. A limit on file size
// behaves like a full disk: at the first byte, where the first outputs fit and the largest does
// not, and where there was nothing before.
TEST_P(Outputs, AreWrittenWholeTogetherOrNotAtAll) {
  const Texts results = made_for_nobody();
  const Texts old = older(results);
  folder_.place(old);
  EXPECT_EQ(run(folder_.command()), 0) << err_;
  EXPECT_NE(folder_.results(), old);
  if (!GetParam().timed) {
    EXPECT_EQ(folder_.results(), results);
  }
  expect_none_fits(0, old);
  expect_none_fits(half_of_largest(results), old);
  expect_none_fits(40, {});
  EXPECT_EQ(folder_.examples(), examples_);
}

TEST_P(Outputs, WithoutANameAreRefused) {
  for (const OutputOption& option : GetParam().outputs) {
    EXPECT_EQ(run(folder_.command({{option.flag, ""}})), 2);
    EXPECT_THAT(err_, HasSubstr(option.flag));
    EXPECT_THAT(err_, HasSubstr(" is empty; name a "));
    EXPECT_THAT(folder_.results(), IsEmpty());
  }
}

// Before the work: a folder as a file, a missing folder, a file as a folder.
TEST_P(Outputs, ThatCannotBeAreRefusedBeforeTheWork) {
  fs::create_directory(folder_.at("folder"));
  for (const OutputOption& option : GetParam().outputs) {
    if (option.files.front() == option.value) {
      EXPECT_EQ(run(folder_.command({{option.flag, "folder"}})), 2);
      EXPECT_THAT(err_, HasSubstr("folder: is a folder; name a file"));
      EXPECT_EQ(run(folder_.command({{option.flag, "no/such/out.csv"}})), 1);
      EXPECT_THAT(err_, HasSubstr("no/such/out.csv: is not writable"));
    } else {
      EXPECT_EQ(run(folder_.command({{option.flag, "examples/CMakeLists.txt/x"}})), 2);
    }
    EXPECT_EQ(folder_.results(), Texts{});
  }
  EXPECT_EQ(folder_.examples(), examples_);
}

// Opening such a pipe waits without end.
TEST_P(Outputs, ThatArePipesNobodyReadsAreRefused) {
  const std::string pipe = folder_.at("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const OutputOption& option : GetParam().outputs) {
    if (option.files.front() == option.value) {
      EXPECT_NE(run(folder_.command({{option.flag, "pipe"}})), 0) << option.flag;
      EXPECT_THAT(err_, HasSubstr("pipe")) << option.flag;
      EXPECT_TRUE(fs::is_fifo(pipe));
    }
  }
}

TEST_P(Outputs, OfInputsThatArePipesNobodyWritesAreRefused) {
  ASSERT_EQ(::mkfifo(folder_.at("pipe").c_str(), 0600), 0);
  for (const std::string& input : GetParam().inputs) {
    auto command = folder_.command();
    if (const auto at = std::ranges::find(command, input); at != command.end()) {
      *at = "pipe";
      EXPECT_EQ(run(command), 2) << input;
      EXPECT_THAT(err_, HasSubstr("pipe: is a named pipe")) << input;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfAllVerbs, Outputs,
                         testing::ValuesIn(output_rows().begin(), output_rows().end()), test_name);

}  // namespace
}  // namespace steadyrest::test
