// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/web/message.hpp>

namespace steadyrest::apps::live_page {

/// A file of the page, within the program.
struct Asset {
  std::string_view path;
  std::string_view content_type;
  std::string_view bytes;
};

/// By the address's path, `/` included; null: there is none.
[[nodiscard]] const Asset* find_asset(std::string_view path) noexcept;
/// The description of the API.
[[nodiscard]] const Asset& openapi() noexcept;
[[nodiscard]] web::Response response_of(const Asset& asset);

}  // namespace steadyrest::apps::live_page
