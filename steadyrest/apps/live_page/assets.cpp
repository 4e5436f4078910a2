// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/apps/live_page/assets.hpp>

extern "C" {
extern const char kSteadyrestLiveHtmlBegin[];
extern const char kSteadyrestLiveHtmlEnd[];
extern const char kSteadyrestLiveScriptBegin[];
extern const char kSteadyrestLiveScriptEnd[];
extern const char kSteadyrestLiveStyleBegin[];
extern const char kSteadyrestLiveStyleEnd[];
extern const char kSteadyrestLiveOpenapiBegin[];
extern const char kSteadyrestLiveOpenapiEnd[];
}

namespace steadyrest::apps::live_page {
namespace {

const std::array<Asset, 3>& assets() noexcept {
  static const std::array<Asset, 3> kAll = {{
      {"/", "text/html; charset=utf-8", {kSteadyrestLiveHtmlBegin, kSteadyrestLiveHtmlEnd}},
      {"/live.js",
       "text/javascript; charset=utf-8",
       {kSteadyrestLiveScriptBegin, kSteadyrestLiveScriptEnd}},
      {"/live.css",
       "text/css; charset=utf-8",
       {kSteadyrestLiveStyleBegin, kSteadyrestLiveStyleEnd}},
  }};
  return kAll;
}

}  // namespace

const Asset* find_asset(std::string_view path) noexcept {
  const auto* const at = std::ranges::find(assets(), path, &Asset::path);
  return at == assets().end() ? nullptr : at;
}

const Asset& openapi() noexcept {
  static const Asset kDescription = {
      "", "application/json", {kSteadyrestLiveOpenapiBegin, kSteadyrestLiveOpenapiEnd}};
  return kDescription;
}

web::Response response_of(const Asset& asset) {
  web::Response out;
  out.content_type = asset.content_type;
  out.body = asset.bytes;
  return out;
}

}  // namespace steadyrest::apps::live_page
