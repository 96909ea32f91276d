"""Draws random sentences from the documents, the help, the messages and the docstrings of headers.

usage: python3 tools/sample_sentences.py SEED COUNT    prints COUNT sentences: [file] (words) sentence
       python3 tools/sample_sentences.py --long WORDS  prints every sentence with more words

A reader who did not write them should understand each one at the first reading (CONTRIBUTING.md).
"""

import random
import re
import subprocess
import sys

FOLDERS = ['docs', 'README.md', 'CONTRIBUTING.md', 'flexura', 'viewer/README.md']
FEWEST_WORDS = 5


def sentences_of(text):
    text = re.sub(r'\s+', ' ', text).strip()
    for sentence in re.split(r'(?<=[.!?:;])\s+(?=[A-Z`"(])', text):
        if len(sentence.split()) >= FEWEST_WORDS and re.search('[a-z]{3}', sentence):
            yield sentence


def markdown_texts(text):
    text = re.sub(r'```.*?```|\$\$.*?\$\$', '', text, flags=re.S)
    for line in text.split('\n'):
        if line.startswith('|'):
            yield from line.split('|')
        elif not line.startswith(('#', '    ')):
            yield re.sub(r'^[-*0-9. ]+', '', line)


def docstrings(text):
    """Yields paragraphs, items of lists, and formulas (indented lines, each of its own)."""
    block = []
    for line in text.split('\n'):
        whole = re.match(r'\s*///(?!<) ?(\s*)(- )?(.*)', line)
        is_item = bool(block) and block[0] == '-'
        if whole and whole.group(3) and not whole.group(2) and (is_item or not whole.group(1)):
            block.append(whole.group(3))
            continue
        yield ' '.join(block[1:] if is_item else block)
        block = []
        if whole and whole.group(2):
            block = ['-', whole.group(3)]
        elif whole and whole.group(1):
            yield whole.group(3)
        elif whole:
            block = [whole.group(3)] if whole.group(3) else []
        behind = re.search(r'///<\s?(.*)', line)
        if behind:
            yield behind.group(1)


def literals(text):
    """Yields string literals, with the parts of one joined."""
    text = re.sub(r'"\s*\n\s*"', '', text)
    for match in re.finditer(r'"((?:\\.|[^"\\\n])*)"', text):
        yield match.group(1)


def all_sentences():
    files = subprocess.run(['git', 'ls-files', *FOLDERS], capture_output=True, text=True, check=True).stdout.split()
    for file in files:
        if file.endswith('.md'):
            texts = markdown_texts
        elif file.endswith('.h'):
            texts = docstrings
        elif file.endswith('.cc') and not file.endswith('_test.cc'):
            texts = literals
        else:
            continue
        with open(file, encoding='utf-8') as opened:
            for text in texts(opened.read()):
                for sentence in sentences_of(text):
                    yield file, sentence


def main(arguments):
    if len(arguments) != 2 or not arguments[1].isdecimal():
        sys.exit(__doc__)
    found = list(all_sentences())
    if arguments[0] == '--long':
        found = [one for one in found if len(one[1].split()) > int(arguments[1])]
    else:
        found = random.Random(int(arguments[0])).sample(found, int(arguments[1]))
    for file, sentence in found:
        print(f'[{file}] ({len(sentence.split())}) {sentence}')


if __name__ == '__main__':
    main(sys.argv[1:])
