// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

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

}  // namespace

/// Plays every file of the named folders through a fuzz target's entry point, without libFuzzer.
int main(int argc, char** argv) {
  int files = 0;
  for (int i = 1; i < argc; ++i) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i])) {
      if (entry.is_regular_file()) {
        std::ifstream in(entry.path(), std::ios::binary);
        play_cut({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
        ++files;
      }
    }
  }
  std::printf("%d files\n", files);
  return files > 0 ? 0 : 1;
}
