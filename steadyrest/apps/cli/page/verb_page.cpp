// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/core.h>
#include <termios.h>
#include <unistd.h>

#include <steadyrest/apps/cli/page/verb_page.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/web/accounts.hpp>

namespace steadyrest::apps::cli {
namespace page {
namespace {

using web::Accounts;
using web::Role;

struct Options {
  std::string file;
  std::string name;
  std::string role = "viewer";
};

/// The terminal does not show what is typed while this lives.
class Unseen {
 public:
  Unseen() {
    on_terminal_ = ::tcgetattr(STDIN_FILENO, &before_) == 0;
    if (on_terminal_) {
      termios now = before_;
      now.c_lflag &= ~static_cast<tcflag_t>(ECHO | ISIG);  // else an interrupt leaves it so
      ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &now);
    }
  }
  Unseen(const Unseen&) = delete;
  Unseen& operator=(const Unseen&) = delete;
  ~Unseen() {
    if (on_terminal_) {
      ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
    }
  }
  [[nodiscard]] bool on_terminal() const noexcept { return on_terminal_; }

 private:
  termios before_{};
  bool on_terminal_ = false;
};

std::string typed(const char* prompt, bool shown) {
  if (shown) {
    std::cerr << prompt;
  }
  std::string line;
  std::getline(std::cin, line);
  if (shown) {
    std::cerr << '\n';
  }
  return line;
}

/// From the terminal, twice; else the first line of what comes in.
Result<std::string> password() {
  const Unseen unseen;
  std::string first = typed("Password: ", unseen.on_terminal());
  if (unseen.on_terminal() && typed("Once more: ", true) != first) {
    return refuse("the two passwords differ", "type the same one twice");
  }
  return first;
}

/// `users.json` in the user's configuration folder.
std::string usual_file() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  const char* const home = std::getenv("HOME");
  const std::string folder = config != nullptr && *config != '\0' ? config
                             : home != nullptr                    ? std::string(home) + "/.config"
                                                                  : "/etc";
  return folder + "/steadyrest/users.json";
}

/// The accounts so far; none where the file is not there yet.
Result<Accounts> accounts_of(const std::string& file) {
  std::error_code fault;
  return std::filesystem::exists(file, fault) ? Accounts::read(file) : Accounts();
}

Outcome written(const Accounts& accounts, const Options& options, std::string text, Json json) {
  std::error_code fault;  // shows when the file is written
  std::filesystem::create_directories(std::filesystem::path(options.file).parent_path(), fault);
  if (auto done = accounts.write(options.file); !done) {
    return refused(done.error());
  }
  Answer answer;
  answer.json = std::move(json);
  answer.text = std::move(text);
  return answer;
}

Outcome add_user(const Options& options) {
  auto accounts = accounts_of(options.file);
  if (!accounts) {
    return refused(accounts.error());
  }
  const auto secret = password();
  if (!secret) {
    return refused(secret.error());
  }
  const Role role = web::role_of(options.role).value_or(Role::viewer);
  if (auto set = accounts->set_user(options.name, *secret, role); !set) {
    return refused(set.error());
  }
  return written(*accounts, options, fmt::format("{} is {} now\n", options.name, options.role),
                 {{"name", options.name}, {"role", options.role}});
}

Outcome add_token(const Options& options) {
  auto accounts = accounts_of(options.file);
  if (!accounts) {
    return refused(accounts.error());
  }
  const Role role = web::role_of(options.role).value_or(Role::viewer);
  const auto token = accounts->set_token(options.name, role);
  if (!token) {
    return refused(token.error());
  }
  return written(*accounts, options, *token + "\n",
                 {{"name", options.name}, {"role", options.role}, {"token", *token}});
}

Outcome remove(const Options& options) {
  auto accounts = Accounts::read(options.file);
  if (!accounts) {
    return refused(accounts.error());
  }
  const bool user = accounts->remove_user(options.name);
  const bool token = accounts->remove_token(options.name);
  if (!user && !token) {
    return refused(bad_input(options.file, fmt::format("has no {}", options.name),
                             "see `steadyrest page list`"));
  }
  return written(*accounts, options, options.name + " is removed\n", {{"name", options.name}});
}

Outcome list(const Options& options) {
  const auto accounts = Accounts::read(options.file);
  if (!accounts) {
    return refused(accounts.error());
  }
  Answer answer;
  answer.json = {{"users", Json::array()}, {"tokens", Json::array()}};
  Table table({"name", "role", ""});
  const auto add = [&](const char* key, const char* shown, const auto& entries) {
    for (const Accounts::Entry& entry : entries) {
      answer.json[key].push_back({{"name", entry.name}, {"role", word(entry.role)}});
      table.row({entry.name, std::string(word(entry.role)), shown});
    }
  };
  add("users", "password", accounts->users());
  add("tokens", "token", accounts->tokens());
  answer.text = table.text();
  return answer;
}

std::shared_ptr<Options> options_of(Verb& verb, bool names, bool has_role) {
  auto options = std::make_shared<Options>();
  if (names) {
    verb.add_option("NAME", options->name, "1 … 32 letters, digits, dots, dashes, underscores")
        ->required();
  }
  options->file = usual_file();
  verb.add_option("--users", options->file,
                  "File of the accounts, its owner's alone; default: steadyrest/users.json in "
                  "$XDG_CONFIG_HOME, or in ~/.config")
      ->type_name("FILE");
  if (has_role) {
    verb.add_option("--role", options->role,
                    "viewer: sees everything; operator: also modes; engineer: also the machine "
                    "file")
        ->check(CLI::IsMember({"viewer", "operator", "engineer"}));
  }
  return options;
}

}  // namespace
}  // namespace page

void add_verb_page_add_user(Session& session, Verb& verb) {
  auto options = page::options_of(verb, true, true);
  session.on(verb, [options](Progress& /*progress*/) { return page::add_user(*options); });
}

void add_verb_page_add_token(Session& session, Verb& verb) {
  auto options = page::options_of(verb, true, true);
  session.on(verb, [options](Progress& /*progress*/) { return page::add_token(*options); });
}

void add_verb_page_remove(Session& session, Verb& verb) {
  auto options = page::options_of(verb, true, false);
  session.on(verb, [options](Progress& /*progress*/) { return page::remove(*options); });
}

void add_verb_page_list(Session& session, Verb& verb) {
  auto options = page::options_of(verb, false, false);
  session.on(verb, [options](Progress& /*progress*/) { return page::list(*options); });
}

}  // namespace steadyrest::apps::cli
