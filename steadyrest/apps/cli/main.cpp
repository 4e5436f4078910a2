// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/cli/chatter/verb_chatter_detect.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_fit.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_lobes.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_plan.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_radius.hpp>
#include <steadyrest/apps/cli/chatter/verb_chatter_simulate.hpp>
#include <steadyrest/apps/cli/cut/verb_contour_limit.hpp>
#include <steadyrest/apps/cli/cut/verb_cut.hpp>
#include <steadyrest/apps/cli/machine/verb_doctor.hpp>
#include <steadyrest/apps/cli/motion/verb_motion_bench.hpp>
#include <steadyrest/apps/cli/motion/verb_motion_calibrate.hpp>
#include <steadyrest/apps/cli/motion/verb_motion_encoder.hpp>
#include <steadyrest/apps/cli/motion/verb_motion_estimate.hpp>
#include <steadyrest/apps/cli/motion/verb_motion_units.hpp>
#include <steadyrest/apps/cli/program/verb_program_check.hpp>
#include <steadyrest/apps/cli/program/verb_program_compensate.hpp>
#include <steadyrest/apps/cli/program/verb_program_moves.hpp>
#include <steadyrest/apps/cli/program/verb_program_strip.hpp>
#include <steadyrest/apps/cli/program/verb_program_time.hpp>
#include <steadyrest/apps/cli/program/verb_program_verify.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_adapt.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_fit.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_forecast.hpp>
#include <steadyrest/apps/cli/thermal/verb_thermal_plan.hpp>

/// The command line: every verb that works is registered here, in the order in which --help has
/// them.
/// The order here is the order in --help: the main job first, then the verbs that people try next.
int main(int argc, char** argv) {
  using namespace steadyrest::apps::cli;  // NOLINT(google-build-using-namespace): the verbs
  Session session;
  add_verb_cut(session);
  add_verb_doctor(session);
  add_verb_chatter_simulate(session);
  add_verb_contour_limit(session);
  add_verb_motion_units(session);
  add_verb_motion_encoder(session);
  add_verb_motion_estimate(session);
  add_verb_motion_bench(session);
  add_verb_motion_calibrate(session);
  add_verb_chatter_radius(session);
  add_verb_chatter_lobes(session);
  add_verb_chatter_plan(session);
  add_verb_chatter_fit(session);
  add_verb_chatter_detect(session);
  add_verb_thermal_fit(session);
  add_verb_thermal_forecast(session);
  add_verb_thermal_plan(session);
  add_verb_thermal_adapt(session);
  add_verb_program_check(session);
  add_verb_program_moves(session);
  add_verb_program_time(session);
  add_verb_program_compensate(session);
  add_verb_program_strip(session);
  add_verb_program_verify(session);
  return session.main(argc, argv);
}
