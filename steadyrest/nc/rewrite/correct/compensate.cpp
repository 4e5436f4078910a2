// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/correct/compensate.hpp>
#include <steadyrest/nc/rewrite/correct/placing.hpp>
#include <steadyrest/nc/rewrite/text/place_of_head.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>
#include <steadyrest/nc/rewrite/walk/clock.hpp>
#include <steadyrest/nc/rewrite/walk/frame_line.hpp>
#include <steadyrest/nc/rewrite/walk/plain_survey.hpp>
#include <steadyrest/nc/rewrite/walk/schedule.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using kernel::file::OutputFile;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

// One pass over the text (marks, uses of the same variable, place of the head), then survey, walk
// and clock, then the choice of places; writes beside the target, proves, and only then renames.
class Rewriter {
 public:
  Rewriter(const std::string& program, const Plan& plan, const interpret::Config& config,
           const kernel::machine::Machine& machine, const Settings& settings, std::string* text)
      : program_(program),
        text_(text),
        plan_(plan),
        config_(with_unknown_offsets(config, settings)),
        machine_(machine),
        settings_(settings),
        plain_(config.dialect),
        unsaid_(plan.axes.size()),
        frames_(plan.axes.size()),
        head_(settings) {
    for (const AxisPlan& axis : plan.axes) {
      schedules_.emplace_back(axis, settings.window_s);
    }
  }

  Result<Compensated> run(const std::string& output) {
    Result<void> done = look_at_text();
    if (done) {
      done = walk();
    }
    if (done) {
      done = spares_subprograms(output);
    }
    for (std::size_t axis = 0; done && axis < plan_.axes.size(); ++axis) {
      done = place(axis);
    }
    if (done) {
      done = write(output);
    }
    if (!done) {
      return std::unexpected(done.error());
    }
    return std::move(result_);
  }

 private:
  Result<void> refuse(std::uint32_t line, std::string what, std::string to_do) const {
    return kernel::outcome::refuse(program_, line, std::move(what), std::move(to_do));
  }

  void progress(double share, std::string_view what) const {
    if (settings_.progress) {
      settings_.progress(share, what);
    }
  }

  Result<void> look_at_text() {
    // Survey, walk, copy and proof each read the file from its beginning.
    std::error_code ignored;
    if (std::filesystem::exists(program_, ignored) &&
        !std::filesystem::is_regular_file(program_, ignored)) {
      return refuse(0, "not a file that can be read twice", "give a file, not a pipe or a folder");
    }
    auto lines = SourceLines::open(program_);
    if (!lines) {
      return std::unexpected(lines.error());
    }
    while (lines->next()) {
      // Plain words hold no mark and name no variable.
      const bool bare = plain_.look(lines->line());
      if (!bare && is_inserted(lines->line())) {
        return refuse(lines->number(), "already has corrections",
                      "take the corrections out first: `program strip`");
      }
      if (std::string use = bare ? "" : own_use(settings_, lines->line()); !use.empty()) {
        return refuse(lines->number(), std::move(use), std::string(against_own_use(settings_)));
      }
      head_.look(lines->line(), lines->number());
    }
    return lines->whole();
  }

  Result<void> walk() {
    auto surveyed = survey(program_, config_, plain_);
    if (!surveyed) {
      return std::unexpected(surveyed.error());
    }
    survey_ = std::move(*surveyed);
    auto walk = Walk::make(program_, config_, survey_, settings_);
    // The clock answers in the order of the questions, so the first one waiting is meant.
    auto clock = Clock::make(machine_, [this](std::uint64_t /*ticket*/, double time_s) {
      waiting_.front().second.time_s = time_s;
      schedules_[waiting_.front().first].offer(waiting_.front().second);
      waiting_.pop_front();
    });
    if (!walk || !clock) {
      return std::unexpected(walk ? clock.error() : walk.error());
    }
    while ((*walk)->step()) {
      look(**walk, **clock);
    }
    if (const auto report = (*walk)->take(); !report.refused.empty()) {
      return std::unexpected(interpret::first_refusal(report, program_));
    }
    // A plan without steps writes nothing, so nothing conflicts with it.
    if (const auto& taken = (*walk)->taken(); taken && corrects(plan_)) {
      return refuse(taken->line, taken->what, taken->to_do);
    }
    const auto total = (*clock)->finish();
    if (!total) {
      Refusal refusal = total.error();
      refusal.file = program_;
      return std::unexpected(std::move(refusal));
    }
    result_.program_s = *total;
    return check_total(plan_, *total);
  }

  Result<void> spares_subprograms(const std::string& output) const {
    // A subprogram's file is read while the output is written and afterwards.
    for (const Survey* one = &survey_; one != nullptr; one = one->other.get()) {
      for (const std::string& file : one->subprogram_files) {
        if (kernel::file::same_place(file, output)) {
          return refuse(0, "calls " + file + ", which the output would replace",
                        "give the output another name");
        }
      }
    }
    return {};
  }

  void look(Walk& walk, Clock& clock) {
    constexpr std::uint32_t kEvery = 1U << 14U;
    if (walk.line() % kEvery == 0) {
      // Two passes over the program, timing and proof: half the progress each.
      progress(0.5 * walk.line() / std::max(survey_.end_line, 1U), "timing");
    }
    for (std::size_t axis = 0; axis < plan_.axes.size(); ++axis) {
      const auto& [letter, index, steps] = plan_.axes[axis];
      const Site site = walk.site(letter, index);
      // Outside the program's coordinates STOPRE would stop in the cut, so feed moves are out.
      // Otherwise a clearance restates the position, which must fit the program's digits.
      const bool writable =
          beside_program(settings_.method)
              ? site != Site::feed
              : site != Site::clearance ||
                    !restate_text(settings_.method, letter, walk.before().position[index],
                                  walk.before().unit_mm, "\n")
                         .empty();
      if (site != Site::none && writable) {
        // The ticket is not needed: answers come in order.
        clock.ask(0);
        waiting_.emplace_back(axis, Place{.line = walk.line(),
                                          .site = site,
                                          .time_s = 0.0,
                                          .position_mm = walk.before().position[index],
                                          .unit_mm = walk.before().unit_mm,
                                          .units_said = walk.units_said(),
                                          .active_offset = walk.before().active_offset});
      }
      // The best explanation if no place is found: the first line that would have been a place.
      if (const Walk::Unsaid* const unsaid = walk.unsaid(letter, index);
          unsaid != nullptr && unsaid_[axis].first == 0) {
        unsaid_[axis] = {walk.line(), *unsaid};
      }
      const Frame frame = walk.frame(letter);
      // A note of the work offset must follow each change of it, even where the frame is kept.
      const bool noted = settings_.method == Method::linuxcnc && walk.sets_offset(letter);
      if (noted || walk.ends() || (frame != Frame::kept && in_work_offset(settings_.method))) {
        const auto& now = walk.run().state();
        frames_[axis].push_back({.line = walk.line(),
                                 .top_line = walk.top_line(),
                                 .frame = walk.ends() ? Frame::kept : frame,
                                 .ends = walk.ends(),
                                 .may_write = walk.may_write(index),
                                 .moves_axis = walk.moves_axis(index),
                                 .incremental_before = walk.before().incremental,
                                 .incremental_behind = now.incremental,
                                 .before = walk.before().active_offset,
                                 .behind = now.active_offset,
                                 .unit_before_mm = walk.before().unit_mm,
                                 .unit_behind_mm = now.unit_mm});
      }
    }
    clock.feed(walk);
  }

  Result<void> place(std::size_t axis) {
    const AxisPlan& plan = plan_.axes[axis];
    if (plan.steps.empty()) {
      return {};
    }
    const auto chosen = schedules_[axis].choose();
    if (!chosen) {
      Refusal refusal = chosen.error();
      refusal.file = program_;
      if (const auto& [line, unsaid] = unsaid_[axis]; line != 0) {
        refusal.line = line;
        refusal.what +=
            fmt::format("; this line would be one, but the program has not said {}", unsaid.what);
        refusal.to_do = unsaid.to_do;
      } else if (survey_.other != nullptr) {
        refusal.what += "; a place must be one with block delete on and off";
      }
      return std::unexpected(std::move(refusal));
    }
    // Frame changes and corrections in program order; `stands_mm` is the correction in force
    // between them.
    std::size_t next = 0;
    double stands_mm = 0.0;
    for (const FrameLine& frame : frames_[axis]) {
      // A correction before this line acts first; so does one below it, in a subprogram.
      while (next < chosen->size() && (*chosen)[next].place.line <= frame.top_line) {
        if (auto put = placing_.put_correction(plan, *chosen, next, stands_mm); !put) {
          return put;
        }
      }
      if (auto put = placing_.put_frame(plan, frame, chosen->front().place.unit_mm, stands_mm);
          !put) {
        return put;
      }
    }
    return {};
  }

  Result<void> write(const std::string& output) {
    const std::string head = whole_head(plan_, settings_);
    if (!head.empty()) {
      // The head goes before anything else inserted at its line and moves those lines down.
      std::string& first = texts_[head_.line()].before_line;
      first.insert(0, head);
      for (const std::size_t index : texts_[head_.line()].insertions) {
        result_.insertions[index].line +=
            static_cast<std::uint32_t>(std::ranges::count(head, '\n'));
      }
    }
    auto lines = SourceLines::open(program_);
    auto writer = OutputFile::open(output);
    if (!lines || !writer) {
      return std::unexpected(lines ? writer.error() : lines.error());
    }
    // A device cannot be read back by name.
    if (writer->path().empty()) {
      return kernel::outcome::refuse(
          output, "is not a file: the changed program is read back for the proof",
          "name a file, not a device or a pipe");
    }
    copy(*lines, *writer);
    if (auto whole = lines->whole(); !whole) {
      return whole;
    }
    if (auto flushed = writer->flush(); !flushed) {
      return flushed;
    }
    progress(0.5, "proving");
    // The proof takes only the times of the insertions from this walk.
    KnownTimes known{.line_s = {}, .program_s = result_.program_s};
    for (const Insertion& one : result_.insertions) {
      known.line_s.emplace(one.original_line, one.time_s);
    }
    auto proof = verify(program_, writer->path(), plan_, config_, machine_, settings_, &known);
    if (!proof) {
      return std::unexpected(of_original(proof.error(), writer->path()));
    }
    result_.proof = *proof;
    if (text_ != nullptr) {
      std::ifstream made(writer->path(), std::ios::binary);
      text_->assign(std::istreambuf_iterator<char>(made), {});
      return {};
    }
    return writer->commit();
  }

  /// The user never sees the refused program: the refusal names the line of the original.
  Refusal of_original(Refusal refusal, const std::string& changed) const {
    if (refusal.file != changed) {
      return refusal;
    }
    refusal.file = program_;
    // The number of lines inserted above the faulty one is subtracted; within a group the line that
    // follows is named.
    std::size_t inserted = 0;
    for (const auto& [line, text] : texts_) {
      if (refusal.line < line + inserted) {
        break;
      }
      const auto here = static_cast<std::size_t>(std::ranges::count(text.before_line, '\n'));
      inserted += std::min(here, refusal.line - line - inserted);
    }
    refusal.line -= inserted;
    refusal.what = "with the corrections written in: " + refusal.what;
    refusal.to_do = "change what the program does here, or leave the axis out of the plan";
    return refusal;
  }

  void copy(SourceLines& lines, OutputFile& writer) {
    std::string ending;
    auto text = texts_.begin();
    // Inserted lines end like the lines around them, so a file keeps one kind of line end.
    while (lines.next()) {
      if (ending.empty()) {
        ending = lines.ending();
      }
      if (text != texts_.end() && text->first == lines.number()) {
        for (const std::size_t index : text->second.insertions) {
          result_.insertions[index].line +=
              lines.number() + static_cast<std::uint32_t>(result_.inserted_lines);
        }
        for (const char c : text->second.before_line) {
          writer.write(c == '\n' ? std::string_view{ending.empty() ? "\n" : ending}
                                 : std::string_view{&c, 1});
          result_.inserted_lines += c == '\n' ? 1U : 0U;
        }
        ++text;
      }
      // Line and line end are adjacent in the buffer: one write.
      writer.write({lines.line().data(), lines.line().size() + lines.ending().size()});
      if (!lines.ending().empty()) {
        ending = lines.ending();
      }
    }
  }

  const std::string& program_;
  std::string* text_;  ///< receives the result in place of the output
  const Plan& plan_;
  const interpret::Config config_;
  const kernel::machine::Machine& machine_;
  const Settings& settings_;
  PlainSurvey plain_;
  Survey survey_;
  std::vector<Schedule> schedules_;
  /// By axis: the first line that would be a place, and what the program has not set before it.
  std::vector<std::pair<std::uint32_t, Walk::Unsaid>> unsaid_;
  std::vector<std::vector<FrameLine>> frames_;  ///< by axis, in the order of execution
  std::deque<std::pair<std::size_t, Place>> waiting_;
  Texts texts_;
  PlaceOfHead head_;
  Compensated result_;
  Placing placing_{program_, settings_, texts_, result_.insertions};
};

}  // namespace

Result<Compensated> compensate(const std::string& program, const std::string& output,
                               const Plan& plan, const interpret::Config& config,
                               const kernel::machine::Machine& machine, const Settings& settings,
                               std::string* text) {
  if (auto checked = check_plan(plan, settings, config); !checked) {
    return std::unexpected(checked.error());
  }
  return Rewriter(program, plan, config, machine, settings, text).run(output);
}

}  // namespace steadyrest::nc::rewrite
