// A program that is compiled for instructions which the processor lacks says so before it needs the first of them.

#include <unistd.h>

#ifdef __x86_64__

namespace {

// Unused where the program needs no more than any processor has.
[[maybe_unused]] constexpr char
    first[] = "tremie: this program is compiled for processors with ",
    then[] = ", which this one lacks: build it here, or for any processor with -DTREMIE_NATIVE=OFF\n";

template <unsigned long n>
[[maybe_unused, gnu::always_inline, gnu::target("arch=x86-64")]] inline void say(const char (&text)[n]) {
  (void)!write(STDERR_FILENO, text, n - 1);
}

// Before every other constructor of the program, and by the instructions of any processor alone.
[[gnu::constructor(101), gnu::target("arch=x86-64")]] void look_for_instructions() {
  __builtin_cpu_init();
#define TREMIE_NEEDS(name)             \
  if (!__builtin_cpu_supports(name)) { \
    say(first), say(name), say(then);  \
    _exit(2);                          \
  }
#ifdef __SSE4_2__
  TREMIE_NEEDS("sse4.2")
#endif
#ifdef __AVX__
  TREMIE_NEEDS("avx")
#endif
#ifdef __AVX2__
  TREMIE_NEEDS("avx2")
#endif
#ifdef __FMA__
  TREMIE_NEEDS("fma")
#endif
#ifdef __BMI2__
  TREMIE_NEEDS("bmi2")
#endif
#ifdef __AVX512F__
  TREMIE_NEEDS("avx512f")
#endif
#ifdef __AVX512BW__
  TREMIE_NEEDS("avx512bw")
#endif
#ifdef __AVX512DQ__
  TREMIE_NEEDS("avx512dq")
#endif
#ifdef __AVX512VL__
  TREMIE_NEEDS("avx512vl")
#endif
#ifdef __AVX512VBMI__
  TREMIE_NEEDS("avx512vbmi")
#endif
#ifdef __AVX512VBMI2__
  TREMIE_NEEDS("avx512vbmi2")
#endif
#undef TREMIE_NEEDS
}

}  // namespace

#endif
