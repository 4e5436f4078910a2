// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/live/run_record.hpp>
#include <steadyrest/live/status_json.hpp>
#include <steadyrest/passport/text/text_file.hpp>
#include <steadyrest/record/run_folder.hpp>
#include <steadyrest/supervisor/wish_text.hpp>

namespace steadyrest::apps::cli::live {

namespace {

/// A layer that was killed may have begun its record in this very second.
std::string free_name(const std::filesystem::path& folder, const std::string& utc) {
  auto file = folder / record::run_name(utc);
  std::error_code fault;
  for (int again = 2; std::filesystem::exists(file, fault); ++again) {
    file = folder / record::run_name(utc, again);
  }
  return file.string();
}

/// At once, since a run may take days.
void say_ended(const kernel::outcome::Refusal& fault) noexcept {
  std::fputs(("steadyrest: warning: the record ended, the run goes on: " +
              kernel::outcome::text(fault) + "\n")
                 .c_str(),
             stderr);
}

}  // namespace

RunRecord::RunRecord(std::unique_ptr<record::RecordWriter> writer, kernel::port::Port& machine,
                     std::string file)
    : writer_(std::move(writer)), port_(machine, *writer_), file_(std::move(file)) {}

Result<std::unique_ptr<RunRecord>> RunRecord::start(const Of& of, const LivePort& port) {
  if (of.folder.empty()) {
    return nullptr;
  }
  auto machine = passport::read_text(of.machine_file);
  auto program =
      of.program_file.empty() ? Result<std::string>() : passport::read_text(of.program_file);
  if (!machine || !program) {
    return std::unexpected(machine ? program.error() : machine.error());
  }
  record::RunInfo info;
  info.start_utc = record::utc_now();
  info.machine = of.machine;
  info.machine_text = std::move(*machine);
  info.program = of.program_file;
  info.program_text = std::move(*program);
  info.listener = of.listener;
  info.cycle_s = port.period_s;
  info.capability = port.port->capability();
  // What goes wrong here shows when the file is made.
  std::error_code fault;
  std::filesystem::create_directories(of.folder, fault);
  std::string file = free_name(of.folder, info.start_utc);
  auto writer =
      record::RecordWriter::make({.file = file, .info = std::move(info), .on_fault = say_ended});
  if (!writer) {
    return std::unexpected(writer.error());
  }
  return std::unique_ptr<RunRecord>(new RunRecord(std::move(*writer), *port.port, std::move(file)));
}

void RunRecord::listen_to(steadyrest::live::Loop::Config& config) {
  config.on_mode = [this](kernel::machine::Mode mode) {
    writer_->event(record::EventKind::mode, steadyrest::live::word(mode));
  };
  config.on_reload = [this](std::uint32_t text) {
    writer_->event(record::EventKind::reload, text);
  };
  config.on_note = [this](std::string_view words) {
    writer_->event(record::EventKind::note, words);
  };
  config.on_wish = [this](const supervisor::Wish& wish, supervisor::WishOutcome outcome) {
    writer_->event(record::EventKind::wish, supervisor::text_of(wish, outcome).view());
  };
  config.on_fault = [this](std::string_view reason) { writer_->keep(reason); };
  config.on_command = [this](const kernel::signal::Command& command) { port_.record(command); };
}

std::string RunRecord::writing() const {
  return writer_->failed() ? "" : std::filesystem::path(file_).filename().string();
}

Json RunRecord::fault() const {
  const auto fault = writer_->fault();
  return fault ? Json(fault->what) : Json(nullptr);
}

void RunRecord::put(Answer& answer) {
  writer_->flush();
  const auto fault = writer_->fault();
  answer.json["record"] = {{"file", file_},
                           {"dropped", writer_->dropped()},
                           {"fault", fault ? Json(fault->what) : Json(nullptr)}};
  answer.text += fmt::format("record: {}, {} cycles lost\n", file_, writer_->dropped());
  if (fault) {
    answer.exit_code = kFailed;
    answer.text += "the record ended before the run: " + fault->what + "\n";
  }
}

std::function<Json()> status_keys(const LivePort& port, const RunRecord* record) {
  return [&port, record] {
    Json keys = port.shows ? port.shows() : Json::object();
    keys["record_fault"] = record != nullptr ? record->fault() : Json(nullptr);
    return keys;
  };
}

}  // namespace steadyrest::apps::cli::live
