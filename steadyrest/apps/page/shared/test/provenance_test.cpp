// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/apps/page/shared/provenance.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::apps::page {
namespace {

class HashedFile : public ::testing::Test {
 protected:
  std::optional<std::string> hash_of(const std::string& content) {
    return sha256_of_file(folder_.file("hashed", content));
  }

  kernel::file::testing::OwnFolder folder_;
};

// The examples of FIPS 180-2, appendix B.
// Each file of the tests is rewritten with the next content.
TEST_F(HashedFile, HasTheHashOfTheStandard) {
  EXPECT_EQ(hash_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hash_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(hash_of(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(hash_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

// An absent file, a folder, and stdin.
TEST_F(HashedFile, WhatIsNoFileHasNone) {
  EXPECT_EQ(sha256_of_file(folder_.at("absent")), std::nullopt);
  EXPECT_EQ(sha256_of_file(std::filesystem::temp_directory_path().string()), std::nullopt);
  EXPECT_EQ(sha256_of_file("-"), std::nullopt);
}

// A blank, a quote and an empty word each need quoting; the path of the program goes.
TEST(Provenance, TheCommandCanBePastedIntoAShell) {
  const std::array<const char*, 6> words = {"/opt/bin/steadyrest", "cut",       "my part.ngc",
                                            "--machine",           "it's.toml", ""};
  EXPECT_EQ(command_of(static_cast<int>(words.size()), words.data()),
            "steadyrest cut 'my part.ngc' --machine 'it'\\''s.toml' ''");
}

// Leap days, months of 30 days and the leap second :60 are where date checks fail.
TEST(Provenance, TakesDatesOfIso8601Alone) {
  for (const char* good : {"2026-01-02", "2028-02-29", "2026-01-02T03:04", "2026-12-31T23:59:60Z",
                           "2026-01-02T03:04:05+01:00"}) {
    EXPECT_TRUE(is_iso_date(good)) << good;
  }
  for (const char* bad : {"", "today", "2026-13-01", "2026-01-32", "2026-02-29", "2026-04-31",
                          "02.01.2026", "2026-01-02 03:04", "2026-01-02T25:00Z", "2026-01-02<b>"}) {
    EXPECT_FALSE(is_iso_date(bad)) << bad;
  }
  EXPECT_TRUE(is_iso_date(now_utc())) << now_utc();
}

TEST(Provenance, IsInThePage) {
  Json page = page_head("steadyrest-report/1");
  put_provenance(page,
                 {.date = std::nullopt,
                  .command = "steadyrest cut a.ngc",
                  .inputs = {{.file = "a.ngc", .sha256 = "00ff"}, {.file = "-", .sha256 = {}}}});
  EXPECT_TRUE(page["made"]["date"].is_null());
  EXPECT_EQ(page["made"]["command"], "steadyrest cut a.ngc");
  EXPECT_EQ(page["made"]["inputs"][0], Json({{"file", "a.ngc"}, {"sha256", "00ff"}}));
  EXPECT_TRUE(page["made"]["inputs"][1]["sha256"].is_null());
}

}  // namespace
}  // namespace steadyrest::apps::page
