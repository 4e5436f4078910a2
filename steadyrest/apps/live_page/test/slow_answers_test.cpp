// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/test/page_desk.hpp>

// What takes long is made beside the other answers: web/test/slow_answers_test.cpp shows that those
// do not wait for it.
namespace steadyrest::apps::live_page {
namespace {

using test::PageDesk;

class AnswersOfThePage : public testing::Test {
 protected:
  AnswersOfThePage() {
    desk.desk().records = STEADYREST_SOURCE_DIR "/examples/records";
    desk.log_in();
  }
  bool slow(const std::string& method, const std::string& path, const std::string& body = {}) {
    auto request = PageDesk::request(method, path, body);
    request.cookie = desk.cookie();
    request.csrf = desk.csrf();
    const web::Response got = desk.api().answer(request);
    EXPECT_EQ(got.status, 200U) << path << got.body;
    return static_cast<bool>(got.later);
  }
  PageDesk desk;
};

TEST_F(AnswersOfThePage, WaitForNoRecord) {
  const std::string record = "/api/v1/records/circle-start.sqlite";
  for (const std::string& path :
       {std::string("/api/v1/records"), record, record + "/data", record + "/export"}) {
    EXPECT_TRUE(slow("GET", path)) << path;
  }
  EXPECT_TRUE(slow("POST", record + "/replay", "{}"));
  for (const std::string path :
       {"/api/v1/status", "/api/v1/session", "/api/v1/machine", "/api/v1/thermal"}) {
    EXPECT_FALSE(slow("GET", path)) << path;
  }
  EXPECT_FALSE(slow("POST", "/api/v1/mode", R"({"mode":"advise"})"));
  EXPECT_FALSE(slow("POST", "/api/v1/hand-back", "{}"));
}

TEST_F(AnswersOfThePage, AreRefusedAtOnceToWhoeverMayNotHaveThem) {
  const web::Response got =
      desk.api().answer(PageDesk::request("GET", "/api/v1/records/circle-start.sqlite/export"));
  EXPECT_EQ(got.status, 401U);
  EXPECT_FALSE(static_cast<bool>(got.later));
}

}  // namespace
}  // namespace steadyrest::apps::live_page
