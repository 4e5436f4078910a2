// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <steadyrest/apps/report/report_data.hpp>
#include <steadyrest/apps/report/write_files.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::report {

/// `report.json`: one object, keys in a fixed order, traces as columns, values rounded to what a
/// person can use (1e-4 s, 1e-4 mm, 0.01 µm). Not-finite values become null, bytes that are not
/// UTF-8 the replacement character.
[[nodiscard]] std::string to_json(const ReportData& data);
/// One object in text; null where there is no number.
[[nodiscard]] std::string to_json(const VibrationFigures& vibration);

/// `report.html`: the page (built from web/) with the JSON inside. It opens from disk, without any
/// server, and nothing in the data can leave its script element.
[[nodiscard]] std::string to_html(std::string_view json);

/// Both into `directory`, see write_files().
[[nodiscard]] kernel::outcome::Result<WrittenFiles> write_report(
    const ReportData& data, const std::filesystem::path& directory);

}  // namespace steadyrest::apps::report
