"""Selects mutants that may compile: most C++ mutants of universalmutator visibly do not."""
import os
import re


def words(text):
    return set(re.findall(r"[A-Za-z_]\w*", text))


NEW_WORDS = words(
    "break continue min max begin end any_of all_of none_of min_element max_element front_inserter back_inserter")
OPERATORS = set("+ - * / % < > <= >= == != && || & | ^ << >> = += -= *= /= %= &= |= ^= <<= >>= ++ -- ! ~ ->".split())
PAIRS = ("()", "[]", "{}")
DECLARATION = re.compile(r"(const|constexpr|static|inline|auto|using|explicit|virtual|template|friend|\[\[|#)"
                         r"|(?!return|break|continue)(std::)?[\w:]+(<.*>)?[&*]? \w+ ?[={;(]")


def without_comments(text):
    return re.sub(r"//.*", "", re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL))


def balance(text):
    return [text.count(pair[0]) - text.count(pair[1]) for pair in PAIRS]


def change(before, after):
    """(old text, new text, the text before it, the text after it)"""
    first = len(os.path.commonprefix([before, after]))
    last = len(os.path.commonprefix([before[first:][::-1], after[first:][::-1]]))
    return before[first:len(before) - last], after[first:len(after) - last], before[:first], before[len(before) - last:]


def number_fits(now, ahead, behind):
    """Where a literal, or a part of one, became another number."""
    if ahead[-1:].isalnum() or ahead[-1:] in ("_", ".", "'") or behind[:1] == "'":
        return now.isdigit()
    if behind[:1] in ("x", "b"):
        return now == "0"
    return now.isdigit() or now == "-1" or not (behind[:1].isalnum() or behind[:1] == ".")


def operator_fits(was, now, ahead, behind):
    """Between spaces an operator has two operands; otherwise it is a template's bracket, a reference, a pointer or a
    sign."""
    more_ahead, more_behind = (re.search(pattern, text)[0]
                               for pattern, text in ((r"[-+*/%<>=!&|]*$", ahead), (r"^[-+*/%<>=!&|]*", behind)))
    ahead, behind = ahead[:len(ahead) - len(more_ahead)], behind[len(more_behind):]
    was, now = more_ahead + was + more_behind, more_ahead + now + more_behind
    if ahead[-1:] == "'":
        return True
    if ahead[-1:] in (" ", "") and behind[:1] in (" ", "\n", ""):
        return now in OPERATORS and not (was == "+" and '"' in ahead + behind)
    return {was, now} <= {"", "-", "+", "!"} or {was, now} <= {"++", "--"}


def constant_fits(before, after):
    """Whether (1==1) or (0==1) replaces an operand and the line keeps its end."""
    ahead = re.search(r"(\S*)\s*\([01]==1\)", after)[1]
    return (before.rstrip()[-1:] == after.rstrip()[-1:] and before.count(";") == after.count(";")
            and (ahead in ("", "=", "return", "if", "while") or ahead.endswith(("(", "!", "&&", "||", "?"))))


def fits(before, after):
    was, now, ahead, behind = change(before, after)
    if "static_assert" in before or after.count('"') % 2:
        return False
    if re.search(r"\([01]==1\)", after):
        return constant_fits(before, after)
    if was.isdigit() and re.search(r"\d", now):
        return number_fits(now, ahead, behind)
    if not re.search(r"[\w\s()\[\]{}\"',;]", was + now):
        return operator_fits(was, now, ahead, behind)
    if "," in was and "," in now and sorted(was.replace(" ", "")) == sorted(now.replace(" ", "")):
        return balance(was) == [0, 0, 0] and was.find("(") <= was.find(")")
    return now != "0" or not ahead.endswith("at(") or bool(re.search(r"\bat\($", ahead))


def is_statement(code, ahead):
    """Whether the code compiles without the line: a whole statement that declares nothing, or an operand."""
    if code.endswith(("&&", "||")):
        return True
    return code.endswith(";") and not DECLARATION.match(code) and (not ahead
                                                                   or ahead.endswith((";", "{", "}", ":", ">")))


def kind_of(text):
    """Kind of the block that a brace opens, from the text before it."""
    if re.search(r"\b(for|while)\s*\(|\bdo\s*$", text) and "[" not in text.rsplit("(", 1)[-1]:
        return "loop"
    if re.search(r"\bswitch\s*\(", text):
        return "switch"
    if re.search(r"\b(if|else)\b|^\s*$|:\s*$", text) and "[&" not in text:
        return "block"
    return "other"


def scopes(lines):
    """The kinds of the braces that are open behind each line."""
    stack, text, found = [], "", []
    for line in lines:
        for character in re.sub(r'"(\\.|[^"\\])*"|\'(\\.|[^\'\\])\'', "0", re.sub(r"//.*", "", line)):
            if character == "{":
                stack.append(kind_of(text))
            elif character == "}" and stack:
                stack.pop()
            text = "" if character in "{};" else text + character
        found.append(tuple(stack))
    return found


def may_stop(statement, scope):
    """Whether break or continue is inside of a loop or a switch."""
    for kind in reversed(scope):
        if kind == "loop" or (kind == "switch" and statement == "break"):
            return True
        if kind == "other":
            return False
    return False


class Filter:
    def __init__(self, lines):
        self._lines = [without_comments(line).strip() for line in lines]
        self._scopes = scopes(lines)

    def passes(self, number, before, after):
        """`number`: of the line, from 1."""
        code, changed = without_comments(before), without_comments(after)
        if not code.strip() or code == changed or balance(code) != balance(changed):
            return False
        if not words(changed) - words(code) <= NEW_WORDS:
            return False
        if changed.count("\n") > code.count("\n"):
            return code.rstrip().endswith((";", "{")) and may_stop(changed.split()[-1].rstrip(";"),
                                                                   self._scopes[number - 1])
        if not changed.strip():
            return is_statement(code.strip(), self._ahead(number))
        return fits(code, changed)

    def _ahead(self, number):
        return next((line for line in reversed(self._lines[:number - 1]) if line), "")
