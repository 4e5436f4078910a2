// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <regex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/shared/usage.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/outcome/nearest.hpp>

// CLI11 reports what its parser missed. A user wants to know which word was wrong and what was
// probably meant; this file finds that out.
namespace steadyrest::apps::cli {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

/// A known word, and what to write for it.
struct Known {
  std::string word;
  std::string written;
};

std::vector<const CLI::App*> below(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* /*any*/) { return true; });
}

/// The verbs at this level; then those one word deeper, which may have been given without their
/// group: `steadyrest lobes` suggests `chatter lobes`.
std::vector<Known> verbs_of(const CLI::App& app) {
  std::vector<Known> out;
  for (const CLI::App* verb : below(app)) {
    out.push_back({verb->get_name(), verb->get_name()});
  }
  for (const CLI::App* group : below(app)) {
    for (const CLI::App* verb : below(*group)) {
      out.push_back({verb->get_name(), group->get_name() + " " + verb->get_name()});
    }
  }
  return out;
}

std::vector<Known> options_of(const CLI::App& app) {
  std::vector<Known> out;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      out.push_back({"--" + name, "--" + name});
    }
  }
  return out;
}

/// Empty if no known word is near: a far-fetched guess is worse than none.
std::string did_you_mean(std::string_view word, const std::vector<Known>& known) {
  std::vector<std::string_view> words;
  words.reserve(known.size());
  for (const Known& one : known) {
    words.push_back(one.word);
  }
  const std::string_view close = kernel::outcome::nearest(word, words);
  const auto found = std::ranges::find(known, close, &Known::word);
  return found == known.end() ? std::string{} : fmt::format("did you mean '{}'? ", found->written);
}

/// How far the parser understood the line: the deepest command and its words, for "see … --help".
std::pair<const CLI::App*, std::string> reached(const CLI::App& root) {
  std::string path = root.get_name();
  const CLI::App* at = &root;
  while (!at->get_subcommands().empty()) {
    at = at->get_subcommands().front();
    path += " " + at->get_name();
  }
  return {at, path};
}

/// CLI11's sentence about an option or its value, in our words. A sentence that matches no pattern
/// stays as it is.
std::string plain(const std::string& sentence) {
  static const std::regex kConvert(R"(Could not convert: (\S+) = (.*))");
  static const std::regex kMissing(R"((\S+): \d+ required .* missing)");
  static const std::regex kTwice(R"((\S+): At Most 1 required but received \d+)");
  static const std::regex kValue(R"((\S+): (?:Value )?(.*))");
  static const std::regex kNotAmong(R"((\S+ \S+) not in \{(.*)\})");
  const auto put = [&sentence](const std::regex& from, const char* to) {
    return std::regex_replace(sentence, from, to, std::regex_constants::format_first_only);
  };
  if (std::regex_match(sentence, kConvert)) {
    return put(kConvert, "$1 $2 is too large");
  }
  if (std::regex_match(sentence, kMissing)) {
    return put(kMissing, "$1 has no value");
  }
  if (std::regex_match(sentence, kTwice)) {
    return put(kTwice, "$1 is given more than once");
  }
  const std::string named = put(kValue, "$1 $2");
  return std::regex_replace(named, kNotAmong, "$1 is none of $2");
}

}  // namespace

/// From the most to the least informative: an unknown option, an unknown verb, an extra word, else
/// CLI11's own message.
Refusal usage_refusal(const CLI::App& root, const CLI::ParseError& error) {
  const auto [at, path] = reached(root);
  const std::string help = fmt::format("see {} --help", path);
  // CLI11 reports the missing word first, although it is missing because another was misspelt. The
  // unknown word is the cause, so it is searched for in both cases.
  const bool leftover = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
                        dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  const std::vector<std::string> words =
      leftover ? root.remaining(true) : std::vector<std::string>{};
  const auto option =
      std::ranges::find_if(words, [](const std::string& word) { return word.starts_with("-"); });
  if (option != words.end() && option->size() > 1) {
    const std::string word = option->substr(0, option->find('='));
    return bad_input(fmt::format("unknown option '{}'", word),
                     did_you_mean(word, options_of(*at)) + help);
  }
  // A leftover word is a verb only where there are verbs below.
  if (!words.empty() && !below(*at).empty()) {
    return bad_input(fmt::format("unknown verb '{}'", words.front()),
                     did_you_mean(words.front(), verbs_of(*at)) + help);
  }
  if (!words.empty()) {
    return bad_input(fmt::format("one argument too many: '{}'", words.front()), help);
  }
  return bad_input(plain(error.what()), help);
}

}  // namespace steadyrest::apps::cli
