// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/chatter_page/chatter_page.hpp>

namespace steadyrest::apps::chatter_page {

Json page_head(std::string_view kind, std::string_view process, const Json& answer) {
  Json page = report::page_head("steadyrest-chatter/1");
  page.update({{"kind", kind}, {"process", process}, {"answer", answer}});
  return page;
}

}  // namespace steadyrest::apps::chatter_page
