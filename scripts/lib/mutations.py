"""Places of C++ sources that a small mistake could change, and what they would then say.

A mutation replaces a part of one line. It is known by its file, the line's text, the text it becomes, and the count of equal
lines above, so that the name of a mutation outlasts changes elsewhere in the file.
"""
import collections
import dataclasses
import re
import subprocess


@dataclasses.dataclass(frozen=True)
class Mutation:
    file: str      # below the repository's root
    number: int    # of the line, from 1
    line: str      # without the blanks around it
    becomes: str
    kind: str
    copy: int      # how many lines above it in the file say the same

    @property
    def key(self):
        return (self.file, self.line, self.becomes, self.copy)


ERROR_NAME = r"[\w.:>()-]*(?:[Ee]rror|slack|bound|margin|Roundoff|kLeast|tolerance|widen)\w*(?:\[\w+\])?(?:\(\w*\))?"
COMPARED = {"<": ["<=", ">"], "<=": ["<", ">="], ">": [">=", "<"], ">=": [">", "<="], "==": ["!="], "!=": ["=="]}
OPPOSITE = {"+": "-", "-": "+", "+=": "-=", "-=": "+=", "&&": "||", "||": "&&", "&=": "|=", "|=": "&=", "&": "|", "|": "&",
            "<<": ">>", ">>": "<<"}
# How much more often than others a kind is drawn: shifted indices are many and are mostly found at once, and error terms are
# few and are what proofs rest on.
WEIGHT = {"error term dropped": 20, "factor of an error dropped": 20, "factor": 20, "extreme": 2, "index": 0.3}
DECLARED_ARRAY = re.compile(r"\s*(?:const |static |mutable )*[\w:]+(?:<[^;=]*>)? \w+(?:\[\w+\])+[;,]")
STATEMENT = re.compile(r"(?!return\b|break\b|continue\b|const\b|auto\b|using\b|case\b|default\b|delete\b|throw\b|static\b)"
                       r"(?:\+\+|--)?\*?[\w.>()\[\]:-]+(?:\([^;]*\)|(?: [+*/|&^-]?= |(?:\+\+|--))[^;{]*)?;")
GUARD = re.compile(r"if \(.*\) (?:return\b[^;]*|continue|break);")


def defined_macros(compiler_words):
    """Names of the macros that the compiler defines by itself."""
    done = subprocess.run([*compiler_words, "-dM", "-E", "-x", "c++", "/dev/null"], capture_output=True, text=True, check=True)
    return {line.split()[1].split("(")[0] for line in done.stdout.splitlines() if line.startswith("#define ")}


def code_only(line):
    """The line with comments and the insides of string literals replaced by blanks, so that positions stay."""
    line = re.sub(r'"(?:[^"\\]|\\.)*"', lambda found: '"' + " " * (len(found[0]) - 2) + '"', line)
    return re.sub(r"//.*", lambda found: " " * len(found[0]), line)


def compiled_lines(text, macros):
    """(number, line, code, code of the line before) of every line that this compiler translates."""
    taken, before, in_assertion = [], "", False

    def holds(condition):
        names = re.findall(r"defined\(?\s*(\w+)", condition) or [condition.split()[0]]
        return all(name in macros for name in names)

    for number, line in enumerate(text.splitlines(), 1):
        code = code_only(line)
        directive = re.match(r"\s*#\s*(ifdef|ifndef|if|elif|else|endif)\b\s*(.*)", code)
        if directive:
            word, condition = directive.groups()
            if word in ("ifdef", "ifndef", "if"):
                now = holds(condition) if word != "ifndef" else condition.split()[0] not in macros
                taken.append([now, now])
            elif word == "endif":
                taken.pop()
            else:  # the second flag says that a branch was taken
                now = not taken[-1][1] and (word == "else" or holds(condition))
                taken[-1] = [now, taken[-1][1] or now]
            continue
        in_assertion = in_assertion or "static_assert" in code
        if code.strip() and all(now for now, _ in taken) and not in_assertion and not code.lstrip().startswith("#"):
            yield number, line, code, before
        if in_assertion and code.rstrip().endswith(";"):
            in_assertion = False
        if code.strip():
            before = code.strip()


def replacements(code, before):
    """(begin, end, new text, kind) of every change of a line. The first of several kinds for one place wins."""
    for found in re.finditer(r"(?<= )(<=|>=|==|!=|<|>)(?= )", code):
        if not re.match(r"\s*template\b", code):
            for other in COMPARED[found[0]]:
                yield *found.span(), other, "comparison"
    for found in re.finditer(rf" [+-] (?:[\w.'-]+ \* )*{ERROR_NAME}(?: \* [\w.]+)?", code):
        yield *found.span(), "", "error term dropped"
    for found in re.finditer(rf"\b(\d[\d.]*[Ff]?) \* (?={ERROR_NAME}|k[A-Z])", code):
        yield *found.span(), "", "factor of an error dropped"
    for found in re.finditer(r"\b0x1p-(\d+)(F?)\b", code):
        yield *found.span(), f"0x1p-{int(found[1]) + 8}{found[2]}", "factor"
    for found in re.finditer(r"\b(\d+(?:\.\d+)?)e-(\d+)(F?)\b", code):
        yield *found.span(), f"{found[1]}e-{int(found[2]) + 3}{found[3]}", "factor"
    for found in re.finditer(r"(?<= )([+-]=?|&&|\|\||&=|\|=|&|\||<<|>>)(?= )", code):
        yield *found.span(), OPPOSITE[found[0]], "operator"
    for found in () if DECLARED_ARRAY.match(code) else re.finditer(r"(?<=[\w\])])\[(\w+)\]", code):
        index = found[1]
        if index.isdigit():
            yield found.start(1), found.end(1), str(int(index) - 1 if int(index) else 1), "index"
        else:
            yield found.start(1), found.end(1), f"{index} + 1", "index"
            yield found.start(1), found.end(1), f"{index} - 1", "index"
    for found in re.finditer(r"(?<=\w) [+-] 1(?=\])", code):
        yield *found.span(), "", "index"
    for found in re.finditer(r"\btrue\b|\bfalse\b", code):
        yield *found.span(), "false" if found[0] == "true" else "true", "truth"
    for found in re.finditer(r"(?<=[ (])!(?=[\w(])", code):
        yield *found.span(), "", "truth"
    for found in re.finditer(r"\bstd::(min|max)\(", code):
        yield found.start(1), found.end(1), "max" if found[1] == "min" else "min", "extreme"
    stripped = code.strip()
    begin = len(code) - len(code.lstrip())
    if before.endswith((";", "{", "}", ":", ")")) and (GUARD.fullmatch(stripped) or STATEMENT.fullmatch(stripped)):
        yield begin, begin + len(stripped), ";", "statement removed"


def mutations_of(name, text, macros):
    counts = collections.Counter()
    for number, line, code, before in compiled_lines(text, macros):
        copy = counts[line.strip()]
        counts[line.strip()] += 1
        seen = set()
        for begin, end, new, kind in replacements(code, before):
            becomes = (line[:begin] + new + line[end:]).strip()
            if becomes not in seen:
                seen.add(becomes)
                yield Mutation(name, number, line.strip(), becomes, kind, copy)


def mutated(text, mutation):
    lines = text.splitlines(keepends=True)
    line = lines[mutation.number - 1]
    if line.strip() != mutation.line:
        raise ValueError(f"{mutation.file}:{mutation.number} does not say: {mutation.line}")
    lines[mutation.number - 1] = line.replace(mutation.line, mutation.becomes)
    return "".join(lines)


def chosen(mutations, count, draw):
    """`count` mutations: every file gets about as many as the root of its own number, and at least one."""
    by_file = collections.defaultdict(list)
    for mutation in mutations:
        by_file[mutation.file].append(mutation)
    for found in by_file.values():  # the least of these numbers are drawn first
        found.sort(key=lambda m: draw.expovariate(WEIGHT.get(m.kind, 1)))
    total = sum(len(found) ** 0.5 for found in by_file.values())
    taken = [m for name in sorted(by_file)
             for m in by_file[name][:max(1, round(count * len(by_file[name]) ** 0.5 / max(total, 1)))]]
    rest = [m for name in sorted(by_file) for m in by_file[name] if m not in set(taken)] if len(taken) < count else []
    draw.shuffle(rest)
    taken += rest[:count - len(taken)]
    draw.shuffle(taken)  # so that a part of the run is a sample, too
    return taken[:count]
