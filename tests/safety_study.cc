// Prints the table of docs/studies/safety.md: safety_study MOTIONS SAMPLES SEED.
#include <cstdint>
#include <cstdio>
#include <string>

#include "tests/support/sampled_check.h"

namespace flexura {
namespace {

void print_row(const char* what, std::size_t count) { std::printf("| %s | %zu |\n", what, count); }

int compare(std::size_t motions, std::size_t samples, std::uint64_t seed) {
  SampledComparison found;
  TestRandom random(seed);
  while (found.motions < motions) compare_with_samples(random, samples, found);
  std::printf("| | |\n| --- | ---: |\n");
  print_row("motions", found.motions);
  print_row("samples of bends, bend rates, stretches and folding", found.samples);
  print_row("time spans of violations of bends, bend rates, stretches and folding that the check reports",
            found.spans);
  print_row("sampled values above their limit", found.above);
  print_row("sampled violations outside every reported time span (missed)", found.missed);
  print_row("samples of clearances", found.contact_samples);
  print_row("time spans of contacts that the check reports", found.contact_spans);
  print_row("sampled contacts", found.contacts);
  print_row("sampled contacts outside every reported time span (missed)", found.contacts_missed);
  print_row("reported time spans longer than two samples that no sample confirms (refuted)", found.refuted);
  print_row(
      "reported time spans without a caveat whose worst value is exceeded by a sample by more than 1e-4 (m, "
      "or relative)",
      found.understated);
  print_row("reported time spans with a caveat whose worst value is exceeded by a sample by more than 1e-4",
            found.flagged);
  std::printf(
      "| largest difference by which a sample exceeds a worst value without a caveat (m, or relative) | %.1e "
      "|\n",
      found.most_understated);
  print_row("reported time spans whose worst value does not occur at its reported time", found.overstated);
  const bool is_right =
      found.missed + found.contacts_missed + found.refuted + found.understated + found.overstated == 0;
  return is_right ? 0 : 1;
}

}  // namespace
}  // namespace flexura

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "usage: safety_study MOTIONS SAMPLES SEED\n"), 2;
  return flexura::compare(std::stoul(argv[1]), std::stoul(argv[2]), std::stoull(argv[3]));
}
