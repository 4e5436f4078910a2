// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <steadyrest/adapters/lines/encoders/encoder_source.hpp>
#include <steadyrest/kernel/machine/links/lines.hpp>

namespace steadyrest::adapters::lines {

/// A recorder on a serial line: a microcontroller that counts edges and stamps the last one.
class SerialRecorder final : public EncoderSource {
 public:
  /// `patience_s`: the longest wait for a sample. Refused: the device cannot be opened, a rate that
  /// serial lines do not have.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<SerialRecorder>> open(
      const kernel::machine::Recorder& recorder, double patience_s);
  ~SerialRecorder() override;

  kernel::outcome::Result<EncoderReading> next() override;
  [[nodiscard]] const RecorderParser::Counts& counts() const noexcept { return parser_.counts(); }

 private:
  SerialRecorder(std::string device, int descriptor, double patience_s)
      : device_(std::move(device)), descriptor_(descriptor), patience_s_(patience_s) {}
  [[nodiscard]] bool drain(RecorderSample& newest, bool& ended);

  std::string device_;
  int descriptor_;
  double patience_s_;
  RecorderParser parser_;
  RecorderTrack track_;
};

}  // namespace steadyrest::adapters::lines
