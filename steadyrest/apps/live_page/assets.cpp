// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/apps/live_page/assets.hpp>

extern "C" {
extern const char steadyrest_live_html_begin[];
extern const char steadyrest_live_html_end[];
extern const char steadyrest_live_script_begin[];
extern const char steadyrest_live_script_end[];
extern const char steadyrest_live_style_begin[];
extern const char steadyrest_live_style_end[];
extern const char steadyrest_live_openapi_begin[];
extern const char steadyrest_live_openapi_end[];
}

namespace steadyrest::apps::live_page {
namespace {

const std::array<Asset, 3>& assets() noexcept {
  static const std::array<Asset, 3> all = {{
      {"/", "text/html; charset=utf-8", {steadyrest_live_html_begin, steadyrest_live_html_end}},
      {"/live.js",
       "text/javascript; charset=utf-8",
       {steadyrest_live_script_begin, steadyrest_live_script_end}},
      {"/live.css",
       "text/css; charset=utf-8",
       {steadyrest_live_style_begin, steadyrest_live_style_end}},
  }};
  return all;
}

}  // namespace

const Asset* find_asset(std::string_view path) noexcept {
  const auto* const at = std::ranges::find(assets(), path, &Asset::path);
  return at == assets().end() ? nullptr : at;
}

const Asset& openapi() noexcept {
  static const Asset description = {
      "", "application/json", {steadyrest_live_openapi_begin, steadyrest_live_openapi_end}};
  return description;
}

web::Response response_of(const Asset& asset) {
  web::Response out;
  out.content_type = asset.content_type;
  out.body = asset.bytes;
  return out;
}

}  // namespace steadyrest::apps::live_page
