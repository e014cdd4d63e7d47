#!/usr/bin/env python3
"""Makes reports with nearfit-cli and checks them with programs that share no code with it: an HTML validator and a browser.

    sudo apt-get install chromium default-jre-headless poppler-utils
    (cd /tmp && npm install vnu-jar)
    tests/app/cli/report_page.py --vnu /tmp/node_modules/vnu-jar/build/dist/vnu.jar --out /tmp/reports [--bin build/release/bin]
        [--csv FILE]

Reports of a clash with a rule and an accepted finding, of a path with its certificate and with one that is refused, of the
demo's path, of names made to break a page, and of a scene without parts. Each must be valid for the Nu HTML checker without
a message (https://validator.w3.org/nu; but for a false alarm, see validator_messages), must name nothing that a browser would fetch or run, and must be shown and printed
by Chromium without asking the network for anything; what it holds as text must be in what it prints. On A4 and on Letter no row
of a table, entry of a list, figure or finding is parted by the end of a page. OUT then has of each report NAME.html, NAME.png
(the screen), NAME-a4.pdf, NAME-letter.pdf, and NAME-a4-1.png ... (its pages on paper) to look at. Ends with 1 if one is not
right. --csv writes a row for each report; results that are kept are of a clean revision: tests/app/results/report_page.csv, of
which resources/scripts/figures makes the table in resources/docs/cli.md.
"""
import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
from html.parser import HTMLParser
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True  # The folder is the repository's.
sys.path.insert(0, str(ROOT / "resources" / "scripts" / "figure_sources"))
import heads  # noqa: E402

# They end tags, attributes, comments and styles, turn the direction of text, or are too long for a line.
HOSTILE_NAMES = ["<script>alert(1)</script>", "\"><img src=https://example.org/x.png onerror=alert(1)>", "</title></style>", "a&amp;b",
                 "--><!--", "abc\u202egpj.exe", "'; drop table parts", "=cmd|'/c calc'!A1", "\u0378\ufeffnobody sees", "軸受け 🔩",
                 "tab\tand newline\n", "LongNameWithoutAnySpace" * 8]
# Attributes that a browser follows or runs. A picture in the page itself is none.
FETCHING = {"src", "srcset", "href", "xlink:href", "data", "action", "formaction", "poster", "background", "ping", "manifest"}
FORBIDDEN_ELEMENTS = {"script", "link", "iframe", "frame", "object", "embed", "base", "form", "audio", "video", "image", "use",
                      "foreignobject"}
FALSE_ALARM = re.compile(r"Resource violates Content Security Policy \(meta tag\): image “data:image/png;base64,.*“img-src” directive")
MINUTES = 60
# As printed a page is parted by lines and hyphens: only letters and digits count.
LETTERS = re.compile(r"[\W_]+", re.UNICODE)
# For what has to stand on one page: a font may lack others.
ASCII = re.compile(r"[^A-Za-z0-9]+")
PAPERS = {"a4": "A4", "letter": "letter"}


class Blocks(HTMLParser):
    """Texts of rows, entries of lists, captions and findings, as ASCII letters and digits, in the order of the page."""

    def __init__(self):
        super().__init__()
        self.texts, self.open = [], []

    def handle_starttag(self, tag, attributes):
        if tag in ("tr", "li", "figcaption") or ("class", "finding") in attributes:
            self.open.append((tag, len(self.texts)))
            self.texts.append("")

    def handle_endtag(self, tag):
        if self.open and self.open[-1][0] == tag:
            self.open.pop()

    def handle_data(self, text):
        for _, index in self.open:
            self.texts[index] += ASCII.sub("", text)


class Outside(HTMLParser):
    """Finds what comes from elsewhere, and keeps the headings."""

    def __init__(self):
        super().__init__()
        self.problems, self.headings, self.open = [], [], []

    def handle_starttag(self, tag, attributes):
        if tag in FORBIDDEN_ELEMENTS:
            self.problems.append(f"a <{tag}>")
        for name, value in attributes:
            value = value or ""
            if name.startswith("on"):
                self.problems.append(f"{name} of a <{tag}>")
            if name in FETCHING and not (value.startswith("#") or (tag == "img" and value.startswith("data:image/png;base64,"))):
                self.problems.append(f"{name}={value[:60]!r} of a <{tag}>")
            if name == "style" or tag == "svg":
                self.check_style(value)
            if name == "http-equiv" and value.lower() == "refresh":
                self.problems.append("a <meta> that leads elsewhere")
        self.open.append(tag)
        if tag in ("h1", "h2"):
            self.headings.append("")

    def handle_endtag(self, tag):
        while self.open and self.open.pop() != tag:
            pass

    def handle_data(self, text):
        if "style" in self.open:
            self.check_style(text)
        if self.headings and self.open and self.open[-1] in ("h1", "h2"):
            self.headings[-1] += text

    def check_style(self, text):
        for word in ("url(", "@import", "@font-face", "expression("):
            if word in text.lower():
                self.problems.append(f"{word} in a style")


def run(*command, codes=(0,)):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=10 * MINUTES)
    if result.returncode not in codes:
        raise RuntimeError(f"{' '.join(map(str, command))} ended with {result.returncode}: {result.stderr.strip()}")
    return result


def write_box(file, size, centre=(0, 0, 0)):
    """Closed, turned outward, in millimetres."""
    corners = [[c + (0.5 if i >> k & 1 else -0.5) * s for k, (c, s) in enumerate(zip(centre, size))] for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    lines = ["v {:.17g} {:.17g} {:.17g}".format(*corner) for corner in corners]
    for a, b, c, d in quads:
        lines += [f"f {a + 1} {b + 1} {c + 1}", f"f {a + 1} {c + 1} {d + 1}"]
    file.write_text("\n".join(lines) + "\n")
    return file


class Reports:
    """Each function makes scene and inputs of one report in a folder of its own, and returns what must be printed."""

    def __init__(self, program, folder, out):
        self.program, self.folder, self.out = program, folder, out

    def cli(self, *arguments, codes=(0,)):
        return run(self.program, *arguments, codes=codes)

    def report(self, name, scene, *options, code):
        self.cli("report", scene, "-o", self.out / f"{name}.html", "--author", "Ada & Grace <ada@example.org>", *options,
                 codes=(code,))

    def clash(self, name):
        """A plate with cubes of 20 mm: one 3 mm deep in it, one that stands on it, one 0.4 mm above, one inside, one far."""
        plate = write_box(self.folder / "plate.obj", (160, 80, 30))
        cube = write_box(self.folder / "cube.obj", (20, 20, 20))
        bolt = write_box(self.folder / "bolt.obj", (4, 4, 4))
        scene = self.folder / "clash.nearfit"
        places = {"Deep": (-60, 0, 22), "Pressed": (-20, 0, 24.99), "Standing": (20, 0, 25), "Near": (60, 0, 25.4), "Far": (0, 0, 90)}
        command = ["scene", "new", scene, "--unit", "mm", "--density", "Deep=7850", "--part", f"Plate={plate}", "--part",
                   f"Enclosed={bolt}"]
        for part, place in places.items():
            command += ["--part", f"{part}={cube}@" + ",".join(str(1e-3 * x) for x in place) + ",1,0,0,0"]
        self.cli(*command)
        self.cli("scene", "rule", scene, "--press-fit", "Pressed:Plate=0.02mm", "--leave-out", "Near:Standing")
        self.cli("clearance", scene, "--all", "--threshold", "1mm", "--save", codes=(3,))
        content = json.loads(scene.read_text())
        for record in content["pairRecords"]:
            if content["parts"][record["other"]]["name"] == "Enclosed":
                record["state"], record["reason"] = "accepted", "It is a weight, cast in <on purpose>."
        scene.write_text(json.dumps(content))
        self.report(name, scene, "--threshold", "1mm", code=3)
        return ["Does not fit", "Deep", "Standing", "Enclosed", "cast in <on purpose>", "What was not checked"]

    def path_inputs(self):
        """A peg that is led over a wall and down into a slot of three blocks."""
        wall = write_box(self.folder / "wall.obj", (10, 60, 40))
        peg = write_box(self.folder / "peg.obj", (12, 12, 50))
        scene, path = self.folder / "slot.nearfit", self.folder / "in.nfpath"
        self.cli("scene", "new", scene, "--unit", "mm", "--part", f"Left wall={wall}@-0.0115,0,0,1,0,0,0", "--part",
                 f"Right wall={wall}@0.0118,0,0,1,0,0,0", "--part", f"Peg={peg}@0,0,0.06,1,0,0,0", "--moving", "Peg")
        count = 400
        poses = []
        for i in range(count + 1):
            share = i / count
            x = 40 * max(0.0, 1 - 2 * share)
            z = 60 if share < 0.5 else 60 - 55 * (2 * share - 1)
            poses.append([4 * share, 1e-3 * x, 0, 1e-3 * z, 1, 0, 0, 0])
        path.write_text(json.dumps({"path": 1, "program": "report_page.py", "parts": ["Peg"], "centre": [0, 0, 0], "poses": poses}))
        return scene, path

    def path(self, name):
        scene, path = self.path_inputs()
        certificate = self.folder / "in.nfcert"
        self.cli("certify", path, scene, "-o", certificate, "--separation", "0.0004")
        self.report(name, scene, "--path", path, "--certificate", certificate, "--threshold", "20mm", code=0)
        return ["The path is proven to keep 0.4 mm", "Proven anew", "Left wall", "time [s]"]

    def refused(self, name):
        scene, path = self.path_inputs()
        certificate = self.folder / "in.nfcert"
        self.cli("certify", path, scene, "-o", certificate, "--separation", "0.0004")
        scene.write_text(scene.read_text() + "\n")
        self.report(name, scene, "--certificate", certificate, code=3)
        return ["The certificate is refused"]

    def demo(self, name):
        """A path felt along a bore, with its contact; not certified."""
        demo = ROOT / "resources" / "demo"
        felt, path = self.folder / "felt.csv", self.folder / "felt.nfpath"
        self.cli("place", demo / "piston.nearfit", "--part", "piston head", "--path", demo / "hand.csv", "--record", felt)
        self.cli("path", felt, demo / "piston.nearfit", "-o", path)
        self.report(name, demo / "piston.nearfit", "--path", path, code=0)
        return ["Between the poses of the path nothing is proven", "Least clearance"]

    def hostile(self, name):
        """Cubes one in another, so that all names are in the tables, and the pictures' descriptions too."""
        scene = self.folder / "hostile.nearfit"
        cube = write_box(self.folder / "cube <b>&amp;.obj", (20, 20, 20))
        command = ["scene", "new", scene, "--unit", "mm"]
        for i, part in enumerate(HOSTILE_NAMES):
            command += ["--part", f"Part {i}={cube}@{0.018 * i},0,0,1,0,0,0"]
        self.cli(*command)
        content = json.loads(scene.read_text())
        for part, hostile in zip(content["parts"], HOSTILE_NAMES):
            part["name"] = hostile
        scene.write_text(json.dumps(content))
        # A name that the program refuses in a scene cannot come into a report.
        if self.program_refuses(scene):
            for part, hostile in zip(content["parts"], HOSTILE_NAMES):
                part["name"] = "".join(c for c in hostile if c.isprintable() or c == "\u202e").strip()
            scene.write_text(json.dumps(content))
        self.cli("scene", "rule", scene, "--leave-out", "<script>*:no </style>")
        self.report(name, scene, code=3)
        # Not the name in Japanese, which needs a font.
        return ["<script>alert(1)</script>", "a&amp;b", r"abc\u{202e}gpj.exe"]

    def program_refuses(self, scene):
        return subprocess.run([str(self.program), "info", str(scene)], capture_output=True).returncode != 0

    def empty(self, name):
        """No command makes a scene without parts; the window saves one."""
        scene = self.folder / "empty.nearfit"
        self.cli("scene", "new", scene, "--unit", "mm", "--part", f"a={write_box(self.folder / 'a.obj', (1, 1, 1))}")
        content = json.loads(scene.read_text())
        content["parts"] = []
        scene.write_text(json.dumps(content))
        self.report(name, scene, code=0)
        return ["Nothing was judged"]


def outside_problems(html):
    parser = Outside()
    parser.feed(html.read_text(encoding="utf-8"))
    if len(parser.headings) < 8:
        parser.problems.append(f"{len(parser.headings)} headings; there should be a title and seven sections at least")
    return parser.problems


def validator_messages(html, jar):
    """(messages, number of false alarms). The checker (26.9.27) holds that any policy with img-src or default-src, even
    "img-src data:", blocks pictures in the page itself. Browsers do not: pictures_missing() proves that they are shown."""
    result = run("java", "-Xss8m", "-jar", jar, "--format", "json", html, codes=(0, 1))
    messages = json.loads(result.stdout + result.stderr)["messages"]
    said = [f"line {m.get('lastLine', 0)}: {m.get('subType', m['type'])}: {m['message']}" for m in messages
            if not FALSE_ALARM.match(m["message"])]
    return said, len(messages) - len(said)


def pictures_missing(html, pdf):
    wanted = html.read_text(encoding="utf-8").count("<img ")
    # One that is the same as another is in the file once.
    distinct = len(set(re.findall(r'src="(data:[^"]*)"', html.read_text(encoding="utf-8"))))
    shown = {line.split()[10] for line in run("pdfimages", "-list", pdf).stdout.splitlines()[2:]}
    return [] if len(shown) >= distinct else [f"{len(shown)} of {wanted} pictures are printed, of which {distinct} differ"]


def requests_in(log):
    """Addresses that the page had the browser ask for, from Chromium's log of the network."""
    text = log.read_text(errors="replace")
    found = set(re.findall(r'"url":"((?:https?|ftp|wss?)://[^"]*)"', text))
    # The browser's own, for updates and the like, which headless Chromium asks of its makers whatever page is shown.
    return sorted(url for url in found if not re.match(r"https?://[^/]*\.?(google|googleapis|gstatic|gvt1)\.com[:/]", url))


def show(html, out, folder):
    """Screen and papers by Chromium; returns what it asks the network for."""
    log = folder / "net.json"
    chromium = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--disable-background-networking",
                "--disable-component-update", "--no-first-run", f"--user-data-dir={folder / 'profile'}"]
    screen = out / f"{html.stem}.png"
    for old in (screen, *out.glob(f"{html.stem}-*.p*")):
        old.unlink(missing_ok=True)
    run(*chromium, f"--log-net-log={log}", "--window-size=1000,2400", f"--screenshot={screen}", html.as_uri())
    text = html.read_text(encoding="utf-8")
    assert text.count("@page {") == 1
    for name, size in PAPERS.items():
        # The paper is the printer's to choose; without one Chromium takes the page's word.
        sized = folder / f"{html.stem}-{name}.html"
        sized.write_text(text.replace("@page {", f"@page {{ size: {size};"), encoding="utf-8")
        pdf = out / f"{html.stem}-{name}.pdf"
        run(*chromium, "--no-pdf-header-footer", f"--print-to-pdf={pdf}", sized.as_uri())
    run("pdftoppm", "-r", "100", "-png", out / f"{html.stem}-a4.pdf", out / f"{html.stem}-a4")
    return requests_in(log)


def pages_of(pdf):
    """Text of each page in the order of the file, where a row's cells follow each other."""
    return run("pdftotext", "-raw", pdf, "-").stdout.split("\f")[:-1]


def missing_in_print(pages, wanted):
    printed = LETTERS.sub("", "".join(pages))
    return [f"{text!r} is not printed" for text in wanted if LETTERS.sub("", text) not in printed]


def parted(html, pages):
    """Rows, entries, captions and findings that are on no page as a whole."""
    blocks = Blocks()
    blocks.feed(html.read_text(encoding="utf-8"))
    printed = [ASCII.sub("", page) for page in pages]
    return [text for text in blocks.texts if not any(text in page for page in printed)]


def is_figure_parted(pdf, pages):
    """True if a page has more captions of pictures than pictures."""
    listed = [line.split() for line in run("pdfimages", "-list", pdf).stdout.splitlines()[2:]]
    pictures = [int(fields[0]) for fields in listed if fields[2] == "image"]
    return any(len(re.findall(r"mm\s+across\.", page)) > pictures.count(i + 1) for i, page in enumerate(pages))


def version_of(*command):
    return run(*command).stdout.strip()


def check(html, wanted, options, folder):
    """(row of the result, problems)"""
    messages, false_alarms = validator_messages(html, options.vnu)
    outside = outside_problems(html)
    requests = show(html, options.out, folder)
    problems = messages + outside + [f"the browser asks for {url}" for url in requests]
    row = {"page": html.stem, "KiB": f"{html.stat().st_size / 1024:.0f}",
           "validator": f"vnu {version_of('java', '-jar', options.vnu, '--version').split()[0]}", "messages": len(messages), "false_alarms": false_alarms, "outside_references": len(outside),
           "browser": " ".join(version_of("chromium", "--version").split()[:2]), "requests": len(requests)}
    for name in PAPERS:
        pdf = options.out / f"{html.stem}-{name}.pdf"
        pages = pages_of(pdf)
        torn = parted(html, pages)
        is_torn = is_figure_parted(pdf, pages)
        row[f"pages_{name}"], row[f"parted_{name}"] = len(pages), len(torn) + is_torn
        problems += [f"{name}: {text[:80]!r} is on no page as a whole" for text in torn]
        problems += [f"{name}: {problem}" for problem in pictures_missing(html, pdf) + missing_in_print(pages, wanted)]
        if is_torn:
            problems.append(f"{name}: a picture and its caption are on different pages")
    row["right"] = "no" if problems else "yes"
    return row, problems


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--bin", type=Path, default=ROOT / "build" / "release" / "bin")
    options.add_argument("--vnu", type=Path, required=True, help="vnu.jar of the Nu HTML checker")
    options.add_argument("--out", type=Path, required=True, help="folder for the pages")
    options.add_argument("--csv", type=Path, help="write the rows to this file too")
    options = options.parse_args()
    for tool in ("java", "chromium", "pdftoppm", "pdftotext", "pdfimages"):
        if shutil.which(tool) is None:
            sys.exit(f"report_page.py: {tool} is missing; see --help for what to install")
    # Nothing is timed.
    head = heads.head_or_exit("report_page.py", options.csv, ROOT, options.bin.resolve().parent, allows_busy=True)
    options.out = options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for name in ("clash", "path", "refused", "demo", "hostile", "empty"):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            wanted = getattr(Reports((options.bin / "nearfit-cli").resolve(), folder, options.out), name)(name)
            row, problems = check(options.out / f"{name}.html", wanted, options, folder)
        print(", ".join(f"{key} {value}" for key, value in row.items()) + ("  NOT RIGHT" if problems else ""))
        for problem in problems:
            print("  " + problem)
        rows.append(row)
    if options.csv:
        heads.write_csv(options.csv, head, rows[0].keys(), rows)
    return 0 if all(row["right"] == "yes" for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
