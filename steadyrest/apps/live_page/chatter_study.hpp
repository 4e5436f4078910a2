// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <thread>

#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::live_page {

/// Stability map and plan of the cut, computed beside the cycle when somebody asks for them: by a
/// thread of the lowest priority, on one core. Its answers say how far it is until it is done.
class ChatterStudy {
 public:
  struct Config {
    std::size_t speeds = 161;  ///< of the map
    std::size_t depths = 49;
    int niceness = 19;  ///< of its thread: the lowest priority
  };
  explicit ChatterStudy(const Desk& desk) : ChatterStudy(desk, Config{}) {}
  ChatterStudy(const Desk& desk, const Config& config);
  ChatterStudy(const ChatterStudy&) = delete;
  ChatterStudy& operator=(const ChatterStudy&) = delete;
  ~ChatterStudy();

  /// `lobes` (null: not yet) with `map`, `border`, `depth_mm`; `progress`. Computed once.
  [[nodiscard]] web::Response lobes();
  /// `plan` (null: not yet), `programmed_rpm`, `progress`. Of the last programmed speed.
  [[nodiscard]] web::Response plan();
  /// Every now and then: sees the programmed speed.
  void look();

 private:
  struct Work {
    bool wanted = false;
    double progress = 0.0;
    double speed_rev_s = 0.0;  ///< of a plan
    std::optional<kernel::outcome::Result<Json>> done;
  };

  void work();
  [[nodiscard]] kernel::outcome::Result<Json> make_lobes();
  [[nodiscard]] kernel::outcome::Result<Json> make_plan(double speed_rev_s);
  void tell(Work& work, double progress);
  [[nodiscard]] static web::Response answer_of(const char* key, const Work& work, Json keys);

  const Desk& desk_;
  Config config_;
  std::atomic<double> programmed_rev_s_{0.0};
  std::mutex mutex_;
  std::condition_variable wake_;
  Work lobes_;
  Work plan_;
  std::atomic<bool> ends_{false};
  std::thread thread_;  ///< last: it uses all the others
};

}  // namespace steadyrest::apps::live_page
