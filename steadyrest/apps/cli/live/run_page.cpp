// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <steadyrest/apps/cli/live/run_page.hpp>
#include <steadyrest/apps/cli/machine/start_checks.hpp>
#include <steadyrest/web/listen.hpp>

namespace steadyrest::apps::cli::live {
namespace {

/// The first option that was given for a page, without one.
std::string without_page(const PageOptions& options) {
  for (const auto& [name, is_given] : {std::pair("--users", !options.users.empty()),
                                       std::pair("--tls-certificate", !options.certificate.empty()),
                                       std::pair("--tls-key", !options.key.empty()),
                                       std::pair("--behind-proxy", !options.behind_proxy.empty()),
                                       std::pair("--trusted-proxy", !options.proxies.empty()),
                                       std::pair("--past-runs", !options.records.empty())}) {
    if (is_given) {
      return name;
    }
  }
  return {};
}

/// For its owner alone; in place of what a layer has left that was killed.
Result<void> write_key(const std::string& file, const std::string& address) {
  ::unlink(file.c_str());
  const int descriptor =
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR);
  const std::string line = address + "\n";
  const bool written = descriptor >= 0 && ::write(descriptor, line.data(), line.size()) ==
                                              static_cast<ssize_t>(line.size());
  const std::string why = std::strerror(errno);
  if (descriptor >= 0) {
    ::close(descriptor);
  }
  if (!written) {
    return refuse(file, "the page's key cannot be written: " + why,
                  "give --socket with a folder that you may write to, or --users");
  }
  return {};
}

Result<live_page::LivePage::Config> config_of(const PageOptions& options) {
  auto place = web::listen_place(options.listen);
  if (!place) {
    return std::unexpected(std::move(place.error()));
  }
  live_page::LivePage::Config out;
  out.address = place->address;
  out.name = place->name;
  out.port = place->port;
  out.accounts_file = options.users;
  out.certificate = options.certificate;
  out.key = options.key;
  out.outer_origin = options.behind_proxy;
  out.proxies = options.proxies;
  return out;
}

}  // namespace

void add_page_options(Verb& verb, PageOptions& options) {
  verb.add_option("--listen", options.listen,
                  "Serve the page here; without an address to this computer alone; port 0: any "
                  "free one")
      ->type_name("[ADDRESS:]PORT");
  verb.add_option("--users", options.users,
                  "Who may log in to the page (steadyrest page add-user); without it a key that a "
                  "terminal shows at the start, else the file SOCKET.page")
      ->type_name("FILE");
  verb.add_option("--tls-certificate", options.certificate, "Certificate of the page (PEM)")
      ->type_name("FILE");
  verb.add_option("--tls-key", options.key, "Its key (PEM)")->type_name("FILE");
  verb.add_option("--behind-proxy", options.behind_proxy,
                  "The page's origin as browsers see it, where a proxy encrypts for it")
      ->type_name("https://NAME");
  verb.add_option("--trusted-proxy", options.proxies,
                  "With --behind-proxy, where others reach --listen: the proxy's address, the only "
                  "one that may connect; may be given several times")
      ->type_name("ADDRESS");
  verb.add_option("--past-runs", options.records,
                  "Folder of the records that the page shows; default: that of --record")
      ->type_name("FOLDER");
}

Result<void> check_page(const PageOptions& options) {
  if (options.listen.empty()) {
    const std::string given = without_page(options);
    return given.empty() ? Result<void>()
                         : refuse(given + " is for the page, and there is none",
                                  "give --listen, too, or leave it out");
  }
  const auto config = config_of(options);
  return config ? live_page::LivePage::check(*config)
                : Result<void>(std::unexpected(config.error()));
}

std::vector<passport::Finding> page_findings(const PageOptions& options) {
  struct ::stat key{};
  if (options.key.empty() || ::stat(options.key.c_str(), &key) != 0 ||
      (key.st_mode & (S_IRWXG | S_IRWXO)) == 0) {
    return {};
  }
  return {{.severity = passport::Severity::warning,
           .check = "page_key",
           .what = fmt::format("other users may read the page's key {} (mode {:04o}), and with it "
                               "pretend to be this page",
                               options.key, key.st_mode & 07777U),
           .to_do = "chmod 600 it"}};
}

Result<void> RunPage::open(const Of& of) {
  if (!wanted_) {
    return {};
  }
  const auto config = config_of(options_);
  if (!config) {
    return std::unexpected(config.error());
  }
  desk_ = std::make_unique<live_page::Desk>(live_page::Desk{
      .asked = of.asked,
      .tap = tap_,
      .machine = of.machine,
      .machine_file = of.machine_file,
      .records = options_.records.empty() ? of.record_folder : options_.records,
      .writing = [record =
                      of.record] { return record != nullptr ? record->writing() : std::string(); },
      .findings = start_findings,
      .cycle_s = of.cycle_s,
      .chatter = of.chatter});
  auto page = live_page::LivePage::open(*config, *desk_);
  if (!page) {
    return std::unexpected(std::move(page.error()));
  }
  page_ = std::move(*page);
  const std::string whole = page_->address_with_key();
  const bool has_key = whole != page_->address();
  if (!has_key || ::isatty(STDERR_FILENO) == 1) {
    std::fputs(("Page: " + whole + "\n").c_str(), stderr);
    return {};
  }
  // Not where a journal keeps it and others read it.
  const std::string file = of.socket + ".page";
  if (auto written = write_key(file, whole); !written) {
    page_.reset();
    return written;
  }
  key_file_ = kernel::file::Temporary(file, kernel::file::Temporary::Kind::file);
  std::fputs(
      fmt::format("Page: {} (its address with the key: {})\n", page_->address(), file).c_str(),
      stderr);
  return {};
}

}  // namespace steadyrest::apps::cli::live
