// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <steadyrest/chatter/offline/response/frf.hpp>
#include <steadyrest/chatter/offline/response/uff58.hpp>

// The same for frequency responses, in both formats.
namespace {

using namespace steadyrest;

void must(bool holds) {
  if (!holds) {
    std::abort();
  }
}

/// Whatever is accepted can be fitted: enough points, rising, finite.
void must_be_fit(const chatter::offline::Frf& frf) {
  must(frf.frequency_hz.size() >= chatter::offline::kLeastPoints);
  must(frf.frequency_hz.size() == frf.compliance_mm_n.size());
  double last = 0.0;
  for (std::size_t i = 0; i < frf.frequency_hz.size(); ++i) {
    must(std::isfinite(frf.frequency_hz[i]) && frf.frequency_hz[i] > last);
    last = frf.frequency_hz[i];
    must(chatter::offline::possible(frf.compliance_mm_n[i]));
  }
}

void must_say(const kernel::outcome::Refusal& refusal) {
  must(!refusal.what.empty() && !refusal.to_do.empty() && refusal.file == "fuzz");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto csv = chatter::offline::parse_frf_csv(text, "fuzz")) {
    must_be_fit(*csv);
  } else {
    must_say(csv.error());
  }
  if (const auto uff = chatter::offline::parse_uff58(text, "fuzz")) {
    must(!uff->empty());
    for (const auto& frf : *uff) {
      must_be_fit(frf);
    }
  } else {
    must_say(uff.error());
  }
  return 0;
}
