#pragma once

// How many threads pay while other programs take turns with them on the same processors. Threads wait for each other
// hundreds of times in a step; where one of them is put off its processor, all do, and two may take several times the
// clock of one. A run whose threads are put off measures fewer of them for a moment, keeps what is faster, and looks again
// later. What is computed does not depend on the number.

namespace tremie::experiment {

/// Chooses, from stretches of a run, the threads of the next one.
class Team {
 public:
  /// At most `threads`.
  explicit Team(int threads) : all_(threads), now_(threads) {}

  /// Takes in what the last stretch was: its work, in any unit, its clock [s] and how often a thread was put off its
  /// processor in it. Returns the threads of the next one.
  int after(double work, double clock, double put_off);

 private:
  int candidate(double put_off_a_second);

  int all_, now_;
  int before_ = 0;            ///< a trial of now_ goes on, in place of so many; 0: none does
  double pace_before_ = 0.0;  ///< of these [s a unit of work]
  double wait_ = 0.0;         ///< until the next trial [s]
  bool more_ = false;         ///< the last trial was of more threads
  double work_ = 0.0, clock_ = 0.0, put_off_ = 0.0;  ///< since a pace was taken
};

/// How often threads of this process were put off their processors so far.
double times_put_off();

/// The wall clock [s].
double clock_now();

}  // namespace tremie::experiment
