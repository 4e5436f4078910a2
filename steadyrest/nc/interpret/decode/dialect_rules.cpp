// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/decode/fanuc/fanuc.hpp>
#include <steadyrest/nc/interpret/decode/hobby/hobby.hpp>
#include <steadyrest/nc/interpret/decode/linuxcnc/linuxcnc.hpp>
#include <steadyrest/nc/interpret/decode/sinumerik/sinumerik.hpp>

namespace steadyrest::nc::interpret {

// A switch, not an array: the compiler names a dialect that is missing here.
const DialectRules& rules_of(read::Dialect dialect) noexcept {
  switch (dialect) {
    case read::Dialect::fanuc:
      return fanuc_rules();
    case read::Dialect::sinumerik:
      return sinumerik_rules();
    case read::Dialect::haas:
      return haas_rules();
    case read::Dialect::grbl:
      return grbl_rules();
    case read::Dialect::mach3:
      return mach3_rules();
    case read::Dialect::linuxcnc:
      break;
  }
  return linuxcnc_rules();
}

}  // namespace steadyrest::nc::interpret
