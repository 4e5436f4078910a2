// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/apps/cli/live/run_record.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/apps/live_page/live_page.hpp>
#include <steadyrest/kernel/file/temporary.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/live/loop.hpp>
#include <steadyrest/live/protocol.hpp>
#include <steadyrest/passport/file/consistency.hpp>

namespace steadyrest::apps::cli::live {

/// How `run` shows its page.
struct PageOptions {
  std::string listen;  ///< `[ADDRESS:]PORT`; empty: no page
  std::string users;
  std::string certificate;
  std::string key;
  std::string behind_proxy;
  std::vector<std::string> proxies;
  std::string records;
};

void add_page_options(Verb& verb, PageOptions& options);

/// Before anything else is opened. Refused: options that do not fit together, accounts that cannot
/// be read.
[[nodiscard]] Result<void> check_page(const PageOptions& options);
/// What is allowed and better otherwise.
[[nodiscard]] std::vector<passport::Finding> page_findings(const PageOptions& options);

/// The page of a run, if one was asked for.
class RunPage {
 public:
  /// For the loop; null: nobody draws.
  [[nodiscard]] steadyrest::live::Tap* tap() noexcept { return wanted_ ? &tap_ : nullptr; }

  explicit RunPage(const PageOptions& options)
      : options_(options), wanted_(!options.listen.empty()) {}

  struct Of {
    const steadyrest::live::Asked& asked;
    const kernel::machine::Machine& machine;
    std::string machine_file;
    std::string socket;  ///< the file with the key lies beside it
    std::string record_folder;
    const RunRecord* record = nullptr;  ///< null: none is written
    double cycle_s = 0.001;
    std::optional<live_page::ChatterDesk> chatter;
  };
  /// Says on stderr where it is; with its key to a terminal alone, else that is in a file of the
  /// user's own while the page is there. What `asked` names outlives the page.
  [[nodiscard]] Result<void> open(const Of& of);
  /// Where; empty: there is none.
  [[nodiscard]] std::string address() const { return page_ ? page_->address() : ""; }
  /// No request is answered any more.
  void close() {
    page_.reset();
    key_file_ = {};
  }

 private:
  PageOptions options_;
  bool wanted_;
  steadyrest::live::Tap tap_;
  std::unique_ptr<live_page::Desk> desk_;
  std::unique_ptr<live_page::LivePage> page_;
  kernel::file::Temporary key_file_;
};

}  // namespace steadyrest::apps::cli::live
