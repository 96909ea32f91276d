// The numbers of docs/studies/safety.md: safety_study MOTIONS SAMPLES SEED prints its table.
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
  print_row("states sampled for bends, bend rates, stretches and folding", found.samples);
  print_row("spans of these that the check reported", found.spans);
  print_row("values above their limit in the samples", found.above);
  print_row("of these outside every reported span (missed)", found.missed);
  print_row("states of which clearances were computed", found.contact_samples);
  print_row("spans of contact that the check reported", found.contact_spans);
  print_row("contacts in these states", found.contacts);
  print_row("of these outside every reported span (missed)", found.contacts_missed);
  print_row("reported spans longer than two samples that no sample confirms (refuted)", found.refuted);
  print_row("reported spans with a sample worse than their worst value, by more than 1e-4 (m, or of it)",
            found.understated);
  print_row("the same, and the check says that it may be so", found.flagged);
  std::printf(
      "| what the worst values are short of, where the check says nothing (m, or of it), at most | %.1e |\n",
      found.most_understated);
  print_row("reported spans whose worst value is not there at its time", found.overstated);
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
