// Threads that spin for long while they wait for each other take whole time slices from a machine that other programs
// use, and from each other. Threads that sleep at once pay for each of the thousands of short waits of a step: the full
// body of 13,000 points takes 9.4 s with two of them, 6.1 s with one thread, and 3.4 s with two that spin for a tenth of
// a millisecond before they sleep. libgomp reads how its threads wait when it is loaded, before main(), and at no other
// time: the program sets it and becomes itself again.

#include "apparatus/cli/process/brief_spin.hpp"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace tremie::cli {
namespace {

constexpr const char* guard = "TREMIE_SPINS_BRIEFLY";

/// The words of this process' command line.
std::vector<std::string> own_arguments() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(in, word, '\0');) words.push_back(word);
  return words;
}

}  // namespace

void spin_briefly(int threads) {
  if (threads < 2 || std::getenv(guard) || std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT"))
    return;
  std::vector<std::string> words = own_arguments();
  if (words.empty()) return;
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  setenv(guard, "1", 1);
  setenv("GOMP_SPINCOUNT", "10000", 1);  // some tenth of a millisecond
  execv("/proc/self/exe", argv.data());
}

}  // namespace tremie::cli
