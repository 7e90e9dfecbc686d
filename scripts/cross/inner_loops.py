"""The inner loops of compiled functions, found in a disassembly."""
import re
import subprocess

MULTIPLIES = "fmla", "sdot", "smmla", "vfmadd132ps", "vfmadd213ps", "vfmadd231ps"  # and adds
FUNCTION = re.compile(r"^[0-9a-f]+ <(.*)>:$")
INSTRUCTION = re.compile(r"^\s*([0-9a-f]+):\s+([a-z][\w.]*)\s*(.*?)(?:\s*(?://|# ).*)?$")
BRANCH = re.compile(r"^(b\.?\w*|cbn?z|tbn?z|j(?!mp)\w+)$")  # of ARM and x86
CALLS = {"bl", "blr", "br", "bic", "bif", "bit", "bsl", "bfi", "bfxil"}


def functions(objdump, path):
    """{demangled name: [(address, mnemonic, operands)]}"""
    text = subprocess.run([objdump, "-d", "-C", "--no-show-raw-insn", path], check=True,
                          capture_output=True, text=True).stdout
    found, body = {}, []
    for line in text.splitlines():
        if match := FUNCTION.match(line):
            body = found.setdefault(match.group(1), [])
        elif match := INSTRUCTION.match(line):
            body.append((int(match.group(1), 16), match.group(2), match.group(3)))
    return found


def loops(body):
    """Bodies of backward branches, each from its target to the branch."""
    index = {address: i for i, (address, _, _) in enumerate(body)}
    for i, (address, mnemonic, operands) in enumerate(body):
        if not BRANCH.match(mnemonic) or mnemonic in CALLS:
            continue
        target = re.search(r"\b([0-9a-f]+) <", operands)
        start = index.get(int(target.group(1), 16)) if target else None
        if start is not None and body[start][0] <= address:
            yield body[start:i + 1]


def busiest_loop(body):
    """The innermost loop with most multiply-adds."""
    candidates = [loop for loop in loops(body) if count(loop, *MULTIPLIES)]
    innermost = [a for a in candidates
                 if not any(b is not a and a[0][0] <= b[0][0] and b[-1][0] <= a[-1][0]
                            for b in candidates)]
    return max(innermost, key=lambda loop: count(loop, *MULTIPLIES))


def count(loop, *mnemonics):
    return sum(mnemonic in mnemonics for _, mnemonic, _ in loop)


def assembly(loop):
    """The loop as a text that an assembler takes; branches lead to its beginning."""
    lines = ["loop:"]
    for _, mnemonic, operands in loop:
        lines.append(f"{mnemonic} " + re.sub(r"\b[0-9a-f]+ <.*", "loop", operands))
    return "\n".join(lines) + "\n"
