// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

/// Classifies an existing file by its content: a result may replace an older result of its kind,
/// and nothing else.
namespace steadyrest::apps::cli {

struct Content {
  std::string name;  ///< name of the kind, with its article
  std::function<bool(std::string_view text)> fits;
};

/// A table whose first line begins with one of these columns.
[[nodiscard]] Content csv_content(std::string name, std::vector<std::string> heads);
/// TOML with only these keys and sections on its top level.
[[nodiscard]] Content toml_content(std::string name, std::vector<std::string> only);
/// A machine file or a thermal passport: TOML with an [[axis]] or a [thermal].
[[nodiscard]] Content machine_content();
/// Corrections: JSON with `transitions` or `axes`.
[[nodiscard]] Content plan_content();
/// A page, and its data, as every report has them.
[[nodiscard]] Content page_content();
[[nodiscard]] Content page_data_content();
/// An NC program of any dialect: half of its first lines are blocks or comments.
[[nodiscard]] Content program_content();
/// Either of two kinds.
[[nodiscard]] Content either(Content one, Content other);

}  // namespace steadyrest::apps::cli
