// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/live/live_status.hpp>
#include <steadyrest/live/protocol.hpp>
#include <steadyrest/live/tap.hpp>
#include <steadyrest/passport/file/consistency.hpp>
#include <steadyrest/web/message.hpp>
#include <steadyrest/web/role.hpp>

namespace steadyrest::apps::live_page {

using Json = nlohmann::ordered_json;

inline constexpr double kPercent = 100.0;
inline constexpr double kMinute_s = 60.0;

/// The cut that the layer listens to.
struct ChatterDesk {
  chatter::offline::Process process;
  double depth_mm = 0.0;
  bool acts = false;  ///< the layer chooses the spindle's step when it hears chatter
  /// What `chatter plan` decides for this programmed speed; takes a while, of any thread.
  std::function<kernel::outcome::Result<Json>(const kernel::machine::Machine& machine,
                                              double programmed_rev_s,
                                              const std::function<void(double share)>& progress)>
      plan;
};

/// The running layer as the page sees it.
struct Desk {
  steadyrest::live::Asked asked;  ///< what the socket's clients ask too
  steadyrest::live::Tap& tap;
  kernel::machine::Machine machine;  ///< that the run began with
  std::string machine_file;
  std::string records;  ///< folder of past runs; empty: none
  /// The name of the record that this run is writing now; an empty name: it writes none. From any
  /// thread.
  std::function<std::string()> writing;
  /// What `doctor` finds in a machine file.
  std::function<std::vector<passport::Finding>(const kernel::machine::Machine&)> findings;
  double cycle_s = 0.001;
  std::optional<ChatterDesk> chatter;  ///< none: the run has no process
};

/// What the loop runs by: another file may have taken over.
[[nodiscard]] kernel::machine::Machine machine_in_force(const Desk& desk);

/// An answer with `version` and these keys.
[[nodiscard]] web::Response answer(const Json& keys, unsigned status = 200);
/// A multiple of `to`; null where the value is not finite.
[[nodiscard]] Json rounded(double value, double to);
/// In µm, to a nanometre.
[[nodiscard]] Json micrometres(double mm);
/// Whether the thermal room has stopped correcting because its readings do not fit: `switched_off`,
/// and why `reason` and `sentence` (null: it has not).
[[nodiscard]] Json switched_off_json(const steadyrest::live::LiveStatus& status);
/// One JSON line, whatever bytes its texts have.
[[nodiscard]] std::string text_of(const Json& json);

}  // namespace steadyrest::apps::live_page
