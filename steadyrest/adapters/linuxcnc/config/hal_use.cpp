// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/hal_use.hpp>
#include <steadyrest/adapters/linuxcnc/config/text_lines.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// Reads HAL files as halcmd does, as far as it concerns components, pins and signals.
namespace steadyrest::adapters::linuxcnc::config {

using kernel::outcome::refuse;
using kernel::outcome::Result;

namespace {

constexpr const char* kLibrary = "/usr/share/linuxcnc/hallib";

bool is_arrow(std::string_view word) {
  return word == "=>" || word == "<=" || word == "<=>";
}

std::optional<std::size_t> whole(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value)
                                                                  : std::nullopt;
}

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    out.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace

std::string Where::text() const {
  return fmt::format("{}:{}", file, line);
}

std::string hal_file_path(const IniFile& ini, const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path library(kLibrary);
  if (name.starts_with("LIB:")) {
    const fs::path path = library / name.substr(4);
    return fs::is_regular_file(path, error) ? path.string() : std::string{};
  }
  const char* const home = std::getenv("HOME");
  if (name.starts_with("~/") && home != nullptr) {
    const fs::path path = fs::path(home) / name.substr(2);
    return fs::is_regular_file(path, error) ? path.string() : std::string{};
  }
  // LinuxCNC's own order: beside the INI file, then its library. An absolute name replaces both.
  for (const fs::path& path : {fs::path(ini.path()).parent_path() / name, library / name}) {
    if (fs::is_regular_file(path, error)) {
      return path.string();
    }
  }
  return {};
}

/// Takes in one HAL command after the other.
class HalReader {
 public:
  HalReader(const IniFile& ini, HalUse& out) : ini_(ini), out_(out) {}

  Result<void> all() {
    if (const IniEntry* two = ini_.find("HAL", "TWOPASS"); two != nullptr && !two->value.empty()) {
      return refuse(two->file, two->line,
                    two->text() + ": what such HAL files do is known only when they run",
                    "set the configuration up without TWOPASS first");
    }
    for (const IniEntry* entry : ini_.all("HAL", "HALFILE")) {
      if (auto done = file_of(*entry, Where::Stage::before); !done) {
        return done;
      }
    }
    for (const auto& [key, is_file] :
         {std::pair{"HALCMD", false}, std::pair{"POSTGUI_HALFILE", true},
          std::pair{"POSTGUI_HALCMD", false}}) {
      for (const IniEntry* entry : ini_.all("HAL", key)) {
        Where where{.file = entry->file,
                    .line = entry->line,
                    .last = entry->line,
                    .stage = Where::Stage::after,
                    .halfile = nullptr};
        auto done = is_file ? file_of(*entry, Where::Stage::after) : command(entry->value, where);
        if (!done) {
          return done;
        }
      }
    }
    return {};
  }

 private:
  Result<void> file_of(const IniEntry& entry, Where::Stage stage) {
    const auto words = words_of(entry.value);
    if (words.empty() && stage == Where::Stage::before) {
      return refuse(entry.file, entry.line,
                    "HALFILE is empty: LinuxCNC reads no HALFILE that comes after it",
                    "delete the line");
    }
    if (words.empty()) {
      return {};
    }
    Where where{.file = {}, .line = 0, .last = 0, .stage = stage, .halfile = &entry};
    return file(words.front(), where, entry.file, entry.line);
  }

  /// `where` says who names the file; its own lines replace file and line in there.
  Result<void> file(const std::string& name, Where where, const std::string& by, std::size_t line) {
    constexpr int kDeepest = 8;
    if (name.ends_with(".tcl")) {
      return refuse(by, line, name + " is a Tcl script: what it loads is known only when it runs",
                    name.ends_with("basic_sim.tcl")
                        ? "start LinuxCNC once; basic_sim.tcl then leaves its commands beside the "
                          "INI file as NAME_cmds.hal: make that the HALFILE instead"
                        : "put its commands into a .hal file and name that as HALFILE");
    }
    const std::string path = hal_file_path(ini_, name);
    const auto text =
        path.empty() ? refuse(by, line, name + " is neither beside the INI file nor in " + kLibrary,
                              "give the file, or delete the line")
                     : read_text(path);
    if (!text) {
      return std::unexpected(text.error());
    }
    if (++depth_ > kDeepest) {
      return refuse(by, line, name + " is sourced more than 8 files deep", "end the circle");
    }
    where.file = path;
    for (const LogicalLine& one : logical_lines(*text)) {
      where.line = one.first;
      where.last = one.last;
      if (auto done = command(one.text, where); !done) {
        return done;
      }
    }
    --depth_;
    return {};
  }

  /// `[SECTION]KEY` or `[SECTION](KEY)` becomes its value, where the INI file has it.
  [[nodiscard]] std::string resolved(const std::string& word) const {
    std::string out = word;
    // A value is not searched in its turn: it may name its own key.
    for (std::size_t at = out.find('['); at != std::string::npos; at = out.find('[', at)) {
      const std::size_t close = out.find(']', at);
      if (close == std::string::npos) {
        break;
      }
      const bool round = close + 1 < out.size() && out[close + 1] == '(';
      const std::size_t begin = close + (round ? 2 : 1);
      const std::size_t end =
          std::min(round ? out.find(')', begin) : out.find_first_of(",.=:+ \t", begin), out.size());
      const IniEntry* const entry = ini_.find(std::string_view(out).substr(at + 1, close - at - 1),
                                              std::string_view(out).substr(begin, end - begin));
      if (entry != nullptr) {
        out.replace(at, std::min(end + (round ? 1 : 0), out.size()) - at, entry->value);
        at += entry->value.size();
      } else {
        ++at;
      }
    }
    return out;
  }

  Result<void> command(const std::string& text, const Where& where) {
    // A comment may follow a command.
    auto words = words_of(std::string_view(text).substr(0, std::min(text.find('#'), text.size())));
    if (words.empty()) {
      return {};
    }
    for (std::string& word : words) {
      word = resolved(word);
    }
    const std::string& verb = words.front();
    if (verb == "loadrt" && words.size() > 1) {
      load(words, where);
    } else if (verb == "net" && words.size() > 1) {
      out_.names_.try_emplace(words[1], where);
      for (std::size_t i = 2; i < words.size(); ++i) {
        link(words[i], words[1], where);
      }
    } else if (verb == "newsig" && words.size() > 1) {
      out_.names_.try_emplace(words[1], where);
    } else if ((verb == "linkps" || verb == "linksp") && words.size() > 2) {
      std::erase_if(words, [](const std::string& word) { return is_arrow(word); });
      const bool pin_first = verb == "linkps";
      if (words.size() > 2) {
        link(words[pin_first ? 1 : 2], words[pin_first ? 2 : 1], where);
      }
    } else if (verb == "unlinkp" && words.size() > 1) {
      out_.pins_.erase(real(words[1]));
    } else if (verb == "alias" && words.size() > 3 && words[1] == "pin") {
      alias_[words[3]] = real(words[2]);
    } else if (verb == "setp" && words.size() > 1) {
      out_.set_.try_emplace(real(words[1]), where);
      if (words.size() > 2) {
        out_.settings_.insert_or_assign(real(words[1]), HalUse::Setting{words[2], where});
      }
    } else if (verb == "source" && words.size() > 1) {
      Where inner = where;
      inner.sourced = true;
      return file(words[1], inner, where.file, where.line);
    }
    return {};
  }

  [[nodiscard]] std::string real(const std::string& pin) const {
    const auto found = alias_.find(pin);
    return found == alias_.end() ? pin : found->second;
  }

  void link(const std::string& pin, const std::string& signal, const Where& where) {
    if (!is_arrow(pin)) {
      out_.pins_.try_emplace(real(pin), Linked{signal, where});
    }
  }

  void load(const std::vector<std::string>& words, const Where& where) {
    Loaded one{.where = where, .count = {}, .names = {}, .others = {}};
    for (std::size_t i = 2; i < words.size(); ++i) {
      const std::string_view word = words[i];
      if (word.starts_with("names=")) {
        one.names = split(word.substr(6));
      } else if (word.starts_with("count=")) {
        one.count = whole(word.substr(6));
        if (!one.count) {
          one.others.emplace_back(word);
        }
      } else {
        one.others.emplace_back(word);
      }
    }
    if (one.names.empty() && one.others.empty() && !one.count) {
      one.count = 1;
    }
    for (const std::string& name : one.names) {
      out_.names_.try_emplace(name, where);
    }
    out_.loaded_.try_emplace(words[1], std::move(one));
  }

  const IniFile& ini_;
  HalUse& out_;
  std::map<std::string, std::string> alias_;
  int depth_ = 0;
};

Result<HalUse> HalUse::of(const IniFile& ini) {
  HalUse out;
  if (auto read = HalReader(ini, out).all(); !read) {
    return std::unexpected(read.error());
  }
  return out;
}

const Loaded* HalUse::loaded(const std::string& component) const {
  const auto found = loaded_.find(component);
  return found == loaded_.end() ? nullptr : &found->second;
}

const Linked* HalUse::linked(const std::string& pin) const {
  const auto found = pins_.find(pin);
  return found == pins_.end() ? nullptr : &found->second;
}

const Where* HalUse::set(const std::string& pin) const {
  const auto found = set_.find(pin);
  return found == set_.end() ? nullptr : &found->second;
}

const HalUse::Setting* HalUse::setting(const std::string& pin) const {
  const auto found = settings_.find(pin);
  return found == settings_.end() ? nullptr : &found->second;
}

const Where* HalUse::named(const std::string& prefix) const {
  const auto found = names_.lower_bound(prefix);
  return found != names_.end() && found->first.starts_with(prefix) ? &found->second : nullptr;
}

std::map<std::string, std::string> HalUse::signals() const {
  std::map<std::string, std::string> out;
  for (const auto& [pin, linked] : pins_) {
    out.emplace(pin, linked.signal);
  }
  return out;
}

std::vector<SpindleUse> HalUse::spindle_uses() const {
  constexpr std::string_view kSpindle = "spindle.0.";
  std::vector<SpindleUse> out;
  for (const auto& [pin, linked] : pins_) {
    if (!pin.starts_with("spindle.0.speed-out")) {
      continue;
    }
    SpindleUse use{.output = pin.substr(kSpindle.size()), .linked = linked, .readers = {}};
    for (const auto& [other, other_linked] : pins_) {
      if (other != pin && other_linked.signal == linked.signal) {
        use.readers.push_back(other);
      }
    }
    out.push_back(std::move(use));
  }
  return out;
}

}  // namespace steadyrest::adapters::linuxcnc::config
