// SPDX-License-Identifier: Apache-2.0
// The offsets that a proof assumes where the control's own are not known.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/text/settings.hpp>

namespace steadyrest::nc::rewrite {
namespace {

// Where the control's data are not known, no two offsets are alike, and none is 0 or rounded.
TEST(UnknownOffsets, AreAllDifferentAndExact) {
  const auto of = [](read::Dialect dialect, bool known) {
    interpret::Config config;
    config.dialect = dialect;
    config.start_known = known;
    return with_unknown_offsets(config, Way{});
  };
  const interpret::Config unknown = of(read::Dialect::linuxcnc, false);
  std::set<double> z_mm = {0.0, unknown.tool_offset[2], unknown.g92[2]};
  for (const auto& offset : unknown.work_offset) {
    z_mm.insert(offset[2]);
  }
  EXPECT_EQ(z_mm.size(), 3U + interpret::kWorkOffsets);
  for (const double mm : z_mm) {
    EXPECT_EQ(std::floor(mm * 1024.0), mm * 1024.0) << "a sum of them is exact";
  }
  EXPECT_TRUE(unknown.g92_on);
  EXPECT_FALSE(of(read::Dialect::sinumerik, false).g92_on) << "it has no G92";
  EXPECT_EQ(of(read::Dialect::linuxcnc, true).tool_offset, interpret::Axes{});
}

// A free external offset is 0 when a program starts; otherwise nobody knows.
TEST(UnknownOffsets, HoldTheExternalOneOfAFanuc) {
  interpret::Config fanuc;
  fanuc.dialect = read::Dialect::fanuc;
  fanuc.work_offset[0][2] = 7.0;
  Way way{.method = Method::fanuc};
  EXPECT_NE(with_unknown_offsets(fanuc, way).external[2], 0.0);
  EXPECT_EQ(with_unknown_offsets(fanuc, way).work_offset[0][2], 7.0) << "given";
  way.external_offset_free = true;
  EXPECT_EQ(with_unknown_offsets(fanuc, way).external[2], 0.0);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
