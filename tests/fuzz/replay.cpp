// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

/// Runs a fuzz target over a corpus without libFuzzer: every file whole, cut off at sixteen places,
/// and changed forty times by the target's own mutator. So the targets run in every build.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
/// A target's own way to change an input; absent where it has none.
extern "C" [[gnu::weak]] std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                             std::size_t most, unsigned seed);

/// In libFuzzer's place: one byte becomes another.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most) {
  static std::minstd_rand random;
  const std::size_t now = size == 0 && most > 0 ? 1 : size;
  if (now > 0) {
    data[random() % now] = static_cast<std::uint8_t>(random() >> 8U);
  }
  return now;
}

namespace {

void play(const std::string& text) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

/// The file whole, and cut off after every sixteenth of it.
void play_cut(const std::string& text) {
  constexpr std::size_t kParts = 16;
  for (std::size_t part = 0; part <= kParts; ++part) {
    play(text.substr(0, text.size() * part / kParts));
  }
}

/// The file changed a little further again and again, by the target's own mutator.
void play_changed(std::string text) {
  constexpr unsigned kTimes = 40;
  constexpr std::size_t kMost = 4096;
  const std::size_t size = std::min(text.size(), kMost);
  text.resize(kMost);
  std::size_t now = size;
  for (unsigned seed = 1; seed <= kTimes; ++seed) {
    auto* const bytes = reinterpret_cast<std::uint8_t*>(text.data());
    // The mutated text is the next one's start, so changes add up.
    now = LLVMFuzzerCustomMutator(bytes, now, kMost, seed);
    play(text.substr(0, now));
  }
}

}  // namespace

/// Plays every file of the named folders through a fuzz target's entry point, without libFuzzer.
int main(int argc, char** argv) {
  int files = 0;
  for (int i = 1; i < argc; ++i) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i])) {
      if (entry.is_regular_file()) {
        std::ifstream in(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        play_cut(text);
        if (LLVMFuzzerCustomMutator != nullptr) {
          play_changed(text);
        }
        ++files;
      }
    }
  }
  std::printf("%d files\n", files);
  return files > 0 ? 0 : 1;
}
