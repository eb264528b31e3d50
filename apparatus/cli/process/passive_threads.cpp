// Threads that spin while they wait for each other take whole time slices from a machine that other programs
// use, and from each other. libgomp reads how its threads wait when it is loaded, before main(), and at no
// other time: the program sets it and becomes itself again.

#include "apparatus/cli/process/passive_threads.hpp"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace tremie::cli {
namespace {

constexpr const char* guard = "TREMIE_WAITS_PASSIVELY";

/// The words of this process' command line.
std::vector<std::string> own_arguments() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(in, word, '\0');) words.push_back(word);
  return words;
}

}  // namespace

void wait_passively(int threads) {
  if (threads < 2 || std::getenv(guard) || std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT"))
    return;
  std::vector<std::string> words = own_arguments();
  if (words.empty()) return;
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  setenv(guard, "1", 1);
  setenv("OMP_WAIT_POLICY", "passive", 1);
  setenv("GOMP_SPINCOUNT", "0", 1);
  execv("/proc/self/exe", argv.data());
}

}  // namespace tremie::cli
