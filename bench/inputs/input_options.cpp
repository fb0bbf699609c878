#include "bench/inputs/input_options.h"

#include "bench/command_line/add_options.h"

namespace cscd::bench {

std::span<const OptionRow<scenes::ImportOptions>> import_options() {
  using I = scenes::ImportOptions;
  static const OptionRow<I> rows[] = {
      {"--clip", &I::clip,
       "the clip, by name or by number from 0, or all (query and view); default all for query, and else the "
       "first\nthat moves the surface"},
      {"--fps", &I::fps, "frames a second; default the file's own rate, or 30 where the file does not say"},
      {"--from-bind-pose", &I::from_bind_pose, "begin half a second earlier, in the bind pose"},
      {"--component", &I::component,
       "all, largest, a number (see inspect), or auto: the largest that is closed and oriented, else the\n"
       "largest"},
      {"--fill-holes", &I::fill_holes, "fill holes of up to so many edges; default none", {{0, 10'000}}},
      {"--flip-inward", &I::flip_inward, "turn closed components that face inward"},
      {"--weld", &I::weld,
       "vertices that are nearer to each other than this share of the diagonal of the model's box become "
       "one;\n"
       "default 1e-6, or less where detail would collapse"}};
  return rows;
}

std::span<const OptionRow<IgnoreRequest>> ignore_options() {
  using I = IgnoreRequest;
  static const OptionRow<I> rows[] = {
      {.name = "--ignore",
       .member = &I::pairs,
       .help = "A:B, two bones, parts or meshes whose contacts and crossings with each other do not count;\n"
               "* in a name stands for any letters, and A:* is A and everything; may be given several times",
       .type = "A:B",
       .repeats = true},
      {"--ignore-neighbours",
       &I::neighbours,
       "ignore bones that are at most so many joints apart, such as both sides of a knee with 1",
       {{0, 1000}}}};
  return rows;
}

std::span<const OptionRow<ThicknessRequest>> thickness_options() {
  using T = ThicknessRequest;
  static const OptionRow<T> rows[] = {
      {.name = "--thickness",
       .member = &T::thickness,
       .help = "what comes this near counts: a length such as 0.01, 5mm where the input tells its unit,\nor "
               "0.2e for mean edges of the pose at rest",
       .type = "R"},
      {"--exclude-rings",
       &T::rings,
       "vertices that at most so many edges join do not collide; a pair of features is left out if\n"
       "all its vertices are so near",
       {{0, 1000}}},
      {.name = "--exclude-near-rest",
       .member = &T::near_rest,
       .help = "nor do vertices that are nearer than this at rest; a length as for --thickness",
       .type = "R"}};
  return rows;
}

void add_model_options(CLI::App& command, ModelOptions& options) {
  using M = ModelOptions;
  static const OptionRow<M> limits[] = {
      {"--import-memory", &M::memory_mib, "MiB that reading the file may take", {{16, 1 << 20}}},
      {"--memory", &M::answer_memory_mib, "MiB that everything after that may take", {{64, 1 << 24}}},
      {"--import-seconds", &M::seconds, "seconds that reading the file may take", {{0.01, 86400.0}}}};
  add_options(command, import_options(), options.import, "Model files");
  add_options<M>(command, limits, options, "Model files");
}

}  // namespace cscd::bench
