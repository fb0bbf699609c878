"""The run of `cscd` that stands for one process where programs are compared (scripts/bench_commits, scripts/compare-samples)."""

# Eight intervals from the middle of a scene, where most happens, four of them timed. Most of a process goes into preparing, so
# repetitions are cheap. About half of what processes differ by on a machine with other work comes from too few of them.
FRAMES = (116, 124)
FRAME_RANGE = "%d:%d" % FRAMES
OPTIONS = ["--frames", FRAME_RANGE, "--time-every", "2", "--time-contacts", "0", "--verify-every", "4", "--repetitions", "31"]
