// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/text/text_check.hpp>

// What must be refused. Each file of the corpus states its refusal in its first line, so the corpus
// grows without a line of code; texts that need odd bytes or sizes are made here.
namespace steadyrest::passport {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kCorpus = fs::path(STEADYREST_SOURCE_DIR) / "tests" / "refused" / "machine";

std::vector<std::string> corpus() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kCorpus)) {
    if (entry.path().extension() == ".toml") {
      names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// What the first line of a file states: `# refuse LINE: a piece of the message`.
struct Promise {
  std::size_t line = 0;
  std::string piece;
};

Promise promise_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string first;
  std::getline(in, first);
  constexpr std::string_view kRefuse = "# refuse ";
  const std::size_t colon = first.find(": ");
  if (!first.starts_with(kRefuse) || colon == std::string::npos || first.size() == colon + 2) {
    ADD_FAILURE() << path << " does not begin with `# refuse LINE: message`";
    return {};
  }
  return {std::stoul(first.substr(kRefuse.size())), first.substr(colon + 2)};
}

class RefusedMachineFile : public testing::TestWithParam<std::string> {};

// The fault, its line, a piece of its message, and no second message: one mistake must not trigger
// others, or people correct the wrong one.
TEST_P(RefusedMachineFile, NamesItsFault) {
  const fs::path path = kCorpus / (GetParam() + ".toml");
  const Promise promise = promise_of(path);
  const AllFaults result = read_all_faults(path.string());
  ASSERT_FALSE(result) << "was accepted";
  const kernel::outcome::Refusal& fault = result.error().front();
  EXPECT_EQ(fault.kind, kernel::outcome::Kind::bad_input);
  EXPECT_EQ(fault.file, path.string());
  EXPECT_EQ(fault.line, promise.line) << kernel::outcome::text(fault);
  EXPECT_THAT(kernel::outcome::text(fault), HasSubstr(promise.piece));
  EXPECT_FALSE(fault.to_do.empty());
  for (const kernel::outcome::Refusal& other : result.error()) {
    EXPECT_EQ(&other, &fault) << "one fault makes another message: "
                              << kernel::outcome::text(other);
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, RefusedMachineFile, testing::ValuesIn(corpus()),
                         [](const testing::TestParamInfo<std::string>& at) {
                           std::string name = at.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// Guards against a corpus that was moved elsewhere: an empty one would pass.
TEST(RefusedMachineFiles, AreAtLeastThirtyFive) {
  EXPECT_GE(corpus().size(), 35U);
}

std::string refusal_of(std::string_view text) {
  const auto result = parse(text, "given.toml");
  return result ? "accepted" : kernel::outcome::text(result.error());
}

TEST(RefusedMachineText, EmptyFile) {
  EXPECT_THAT(refusal_of(""), HasSubstr("given.toml: the file is empty"));
  EXPECT_THAT(refusal_of(" \n\n\t"), HasSubstr("the file is empty"));
}

// An executable, a NUL in a text, UTF-16 with its byte order mark.
TEST(RefusedMachineText, BinaryFile) {
  EXPECT_THAT(refusal_of(std::string_view("\x7f"
                                          "ELF\x02\x01\x01\0\0\0",
                                          10)),
              HasSubstr("given.toml:1: byte 0x7f is not text"));
  EXPECT_THAT(refusal_of(std::string_view("name = \"a\"\n\0\0", 13)),
              HasSubstr("given.toml:2: byte 0x00 is not text"));
  EXPECT_THAT(refusal_of("\xff\xfe"
                         "n\0"),
              HasSubstr("given.toml:1: byte 0xff is not UTF-8"));
}

// The last byte of the file begins a character that never ends.
TEST(RefusedMachineText, EndsInTheMiddleOfACharacter) {
  EXPECT_THAT(refusal_of("# µm \xc2"), HasSubstr("byte 0xc2 is not UTF-8"));
  EXPECT_THAT(refusal_of("# \xe2\x82"), HasSubstr("byte 0xe2 is not UTF-8"));
}

/// A file of the given size that takes no space on the disk: only its length is read.
class SparseFile {
 public:
  explicit SparseFile(std::uintmax_t bytes)
      : path_(folder_.file("large.toml", "name = \"large\"\n")) {
    fs::resize_file(path_, bytes);
  }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  kernel::file::testing::OwnFolder folder_;
  std::string path_;
};

TEST(RefusedMachineText, LargeFileWithoutReadingItWhole) {
  const SparseFile file(200U << 20U);
  const auto result = read(file.path());
  ASSERT_FALSE(result);
  EXPECT_THAT(kernel::outcome::text(result.error()), HasSubstr("larger than 16 MB"));
}

// /dev/zero has no end; only a reader with a limit comes back.
TEST(RefusedMachineText, FileThatNeverEnds) {
  const auto result = read("/dev/zero");
  ASSERT_FALSE(result);
  EXPECT_THAT(kernel::outcome::text(result.error()), HasSubstr("larger than 16 MB"));
}

TEST(RefusedMachineText, NoFileAndAFolder) {
  EXPECT_THAT(kernel::outcome::text(read("no/such/file.toml").error()),
              HasSubstr("no/such/file.toml: cannot be opened: No such file"));
  EXPECT_THAT(kernel::outcome::text(read(kCorpus.string()).error()), HasSubstr("is a folder"));
}

// toml++ and the destructor of its tree recurse; without the check these texts would overflow the
// stack.
TEST(RefusedMachineText, NestingThatWouldExhaustTheStack) {
  std::string keys;
  for (int i = 0; i < 1'000'000; ++i) {
    keys += "a.";
  }
  EXPECT_THAT(refusal_of(keys + "a = 1\n"), HasSubstr("more than 16 dots"));
  EXPECT_THAT(refusal_of("a = " + std::string(1'000'000, '[')), HasSubstr("given.toml:1:"));
  std::string tables;
  for (int i = 0; i < 100'000; ++i) {
    tables += "{a=";
  }
  EXPECT_THAT(refusal_of("a = " + tables), HasSubstr("given.toml:1:"));
}

/// Twenty parts of a key, each written like `part`.
std::string dotted(std::string_view part) {
  std::string out(part);
  for (int i = 1; i < 20; ++i) {
    out += '.';
    out += part;
  }
  return out;
}

// Inside quotes nothing ends a key or begins a comment, and a quote that is escaped or part of a
// longer string's content closes nothing. toml++ accepts each of these (the second test).
const std::vector<std::string> kDeepKeys = {dotted(R"("#")"),
                                            dotted("'#'"),
                                            dotted(R"("=")"),
                                            dotted(R"('[,{')"),
                                            dotted(R"("\"#")"),
                                            dotted(R"("\\")"),
                                            dotted(R"('\')"),
                                            dotted(R"("'#")"),
                                            dotted(R"('"#')"),
                                            dotted(R"("")"),
                                            R"("#" . )" + dotted("a"),
                                            "b = \"\"\"\n\"# \\\"\"\"\n\"\"\"\"\"\n" + dotted("a"),
                                            "b = '''\n''#\\'''''\n" + dotted("a"),
                                            "b = \"\"\"\"\"\"\n" + dotted("a"),
                                            "b = \"\"\"\\\n  #\"\"\"\n" + dotted("a"),
                                            "b = {\"}\" = '#', " + dotted("a") + " = 2}\nc"};

TEST(RefusedMachineText, DeepKeysWhateverTheirQuotesContain) {
  for (const std::string& key : kDeepKeys) {
    EXPECT_THAT(refusal_of(key + " = 1\n"), HasSubstr("more than 16 dots")) << key;
  }
}

/// The deepest table below this one, counting from 0.
int depth_of(const toml::table& table) {
  int deepest = 0;
  for (const auto& [name, node] : table) {
    if (const auto* child = node.as_table()) {
      deepest = std::max(deepest, 1 + depth_of(*child));
    }
  }
  return deepest;
}

TEST(RefusedMachineText, DeepKeysAreDeepToTheParserToo) {
  for (const std::string& key : kDeepKeys) {
    EXPECT_GE(depth_of(toml::parse(key + " = 1\n")), 18) << key;
  }
}

// Dots inside a text or a comment are not parts of a key.
TEST(RefusedMachineText, DotsInTextsAreNoDepth) {
  const std::string dots(40, '.');
  for (const std::string& text : {"a = \"" + dots + "\"", "a = '" + dots + "'", "a = 1 # " + dots,
                                  R"(a = "\")" + dots + R"(" # ")",
                                  "a = \"\"\"\n" + dots + "\n\"\"\"", "\"" + dots + "\" = 1"}) {
    EXPECT_FALSE(unfit_text(text + "\n")) << text;
  }
}

// Two of the five lines have number 0 and come first: missing sections.
TEST(RefusedMachineText, ShowsAllFaultsInTheOrderOfTheirLines) {
  const AllFaults result = parse_all_faults(
      "nmae = \"x\"\n[control]\ndialect = 3\n[contour]\nlimit_mm = 1\n", "given.toml");
  ASSERT_FALSE(result);
  const auto& list = result.error();
  ASSERT_EQ(list.size(), 5U);  // two of the five concern the file as a whole
  EXPECT_TRUE(std::is_sorted(list.begin(), list.end(),
                             [](const auto& a, const auto& b) { return a.line < b.line; }));
  EXPECT_EQ(list[2].line, 1U);
  EXPECT_EQ(list[3].line, 3U);
  EXPECT_EQ(list[4].line, 5U);
}

}  // namespace
}  // namespace steadyrest::passport
