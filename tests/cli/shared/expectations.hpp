// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

#include <nlohmann/json.hpp>

/// What the verbs' tests expect from a line of arguments.
namespace steadyrest::test {

/// The answer with --json; the line must succeed and say nothing on stderr.
nlohmann::json answer_of(const std::string& line);

/// Exit code 2, nothing on stdout, and one line `steadyrest: what; what to do` with `why` in it.
void expect_refused(const std::string& line, const std::string& why = "");
void expect_all_refused(std::initializer_list<std::string> lines);

}  // namespace steadyrest::test
