#pragma once

#include <stdexcept>

namespace tremie::scene {

/// Something that a user can mend: in a scene, an override or the command line. what() holds one line a
/// problem, each with file, line, key and what is allowed. The program turns it into exit code 2, with
/// nothing written.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tremie::scene
