"""What every script does: it takes arguments, refuses bad input, asks git, and installs and builds what it needs."""
import argparse
import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCENES = ("rope", "hand", "octopus", "man", "box", "urchin")


def refuse(text):
    """Ends the script with one line on standard error and status 2."""
    print(f"{pathlib.Path(sys.argv[0]).name}: {text}", file=sys.stderr)
    sys.exit(2)


def parser_of(description):
    """A parser of arguments whose help is the script's docstring."""
    return argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)


def built_program(path):
    program = pathlib.Path(path).resolve()
    if not program.exists():
        refuse(f"{path}: is not there; build it with scripts/reproduce, or name another with --program")
    return program


def program_option(parser):
    """The program that makes the document of figures."""
    parser.add_argument("--program", type=built_program, default=str(ROOT / "build-release" / "cscd"), help="default build-release/cscd")


def run(main):
    """Runs a script, whose exit status is what `main` returns. A file that cannot be read or written ends it with one line."""
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
    except OSError as error:
        refuse(f"{error.filename or 'output'}: cannot be read or written ({error.strerror}); name another file or make room")


def existing_folder(path):
    if not path.is_dir():
        refuse(f"{path}: is not a folder; make it first")
    return path


def made_folder(path):
    """A folder for results, which is made where it is missing."""
    if path.exists() and not path.is_dir():
        refuse(f"{path}: is there and is not a folder; name another")
    path.mkdir(parents=True, exist_ok=True)
    return path


def output_of(*words, **options):
    """What a command prints; refuses a command that fails, with the last lines that it printed."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)
    if done.returncode != 0:
        said = (done.stdout + done.stderr).strip().splitlines()[-20:]
        refuse(f"{' '.join(map(str, words))[:200]}: exit status {done.returncode}: " + "\n".join([""] * (len(said) > 1) + said))
    return done.stdout


def call(*words, **options):
    """Runs a command, which prints what it prints. The script ends with its exit status where that is not 0."""
    done = subprocess.run([str(word) for word in words], **options)
    if done.returncode != 0:
        sys.exit(done.returncode)


def answer_of(program, *words):
    """What a command of cscd writes as JSON. `program` may lie in the working folder."""
    return json.loads(output_of(pathlib.Path(program).resolve(), *words, "--json", "-"))


def git(*words, **options):
    """What git prints of this repository."""
    return output_of("git", "-C", ROOT, *words, **options).strip()


def with_setup(command, **options):
    """Runs a line of bash that uses scripts/lib/setup.sh; the script ends where the line fails."""
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", f'root=$PWD; source scripts/lib/setup.sh; {command}'], cwd=ROOT, text=True,
                          env={**os.environ, "CSCD_SCRIPT": pathlib.Path(sys.argv[0]).name}, **options)
    if done.returncode != 0:
        sys.exit(2)
    return done.stdout


def install(*names):
    """Installs the packages of these lists of setup.sh, such as "build", where they are missing."""
    with_setup("install_packages " + " ".join(f'"${{packages_{name}[@]}}"' for name in names), stdout=sys.stderr)


def build(folder, settings, *targets, compiler="gcc"):
    """Builds in a folder below the root, with the settings of scripts/cmake/SETTINGS.cmake; returns the folder."""
    with_setup(f"build {folder} {settings} {compiler} {' '.join(targets)}", stdout=sys.stderr)
    return ROOT / folder


def measured_program(minutes):
    """The program that is measured, built with all that it is compared with. Says first what it costs."""
    print(f"Costs on 2 idle cores: {minutes} when everything is built; 0.9 GB of packages where all are missing; 1.5 GB below build-release "
          "and .cache; 8 MB in results.", flush=True)
    install("build", "compare", "figures")
    return build("build-release", "release", "cscd") / "cscd"


@contextlib.contextmanager
def new_results(kind):
    """A new folder results/DATE-MACHINE-COMMIT-KIND, which gets its name only when the caller is done without an error."""
    folder = ROOT / with_setup(f'new_results {kind}; echo "$out"', stdout=subprocess.PIPE).strip()
    part = folder.with_name(folder.name + ".part")
    part.mkdir()
    try:
        yield part
        part.rename(folder)
    except BaseException:
        shutil.rmtree(part)
        raise
    print(f"written to {folder.relative_to(ROOT)}" + ("" if "-smoke" in kind else "; git add the folder, then run scripts/pages"))
