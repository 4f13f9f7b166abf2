#!/usr/bin/python3
"""Opens each page of the built manual in Chromium, without a network: check_in_browser.py HTML-FOLDER [--chromium PROGRAM]

The manual is copied to another folder first and opened from there as files.  On each page, at a window of 1200 pixels:
  - every equation is typeset, in fonts that are there, and none is cut;
  - no TeX is left in the text;
  - every file that the page asks for is there, and none is asked for elsewhere;
  - every picture is shown, and no script fails;
  - no line of code is cut, and the page is no wider than the window.
Then the search of the manual must find a word.

  --pictures FOLDER PAGE...     besides, a picture of each of these pages, as doc/theory.html
"""

import argparse
import base64
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.parse

WIDTH, HEIGHT = 1200, 900
PATIENCE = 60    # seconds for one answer of the browser
START = "doc/index.html"

# Runs in the page and returns its faults as a list of lines.
LOOK_AT_PAGE = r"""
(async () => {
  await new Promise(resolve => setTimeout(resolve, 50));    // what scripts put off till the page is loaded
  await document.fonts.ready;
  const faults = [];
  const shorten = text => JSON.stringify(text.trim().replace(/\s+/g, " ").slice(0, 70));

  // Cut: what does not fit into its box, or runs out of it.
  const cut = (box, widest) => box.scrollWidth > box.clientWidth + 1
      && faults.push(`${box.tagName} cut, ${box.scrollWidth} in ${box.clientWidth} pixels: ` + shorten(widest));

  for (const equation of document.querySelectorAll(".math")) {
    const typeset = equation.querySelector(".katex-html");
    if (!typeset || typeset.getBoundingClientRect().width < 1 || equation.querySelector(".katex-error"))
      faults.push("equation not typeset: " + shorten(equation.textContent));
    else if (equation.tagName == "DIV") cut(equation, typeset.textContent);
  }
  for (const font of document.fonts)
    if (font.status == "error") faults.push("font not loaded: " + font.family);

  // Code may hold $ and \, but none of the commands of TeX.  KaTeX keeps its input in .katex-mathml, which nobody sees.
  const command = /\\(begin|bm|cdot|Delta|delta|eta|frac|left|mathbf|mathrm|partial|pi|right|sqrt|sum|text|times)(?![a-z])/;
  const in_prose = /\\[()\[\]]|\\[a-zA-Z]+|\$/;
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const inside = texts.currentNode.parentElement;
    if (inside.closest("script, style, .katex")) continue;
    const text = texts.currentNode.data;
    if (command.test(text) || (in_prose.test(text) && !inside.closest("pre, code, .math")))
      faults.push("TeX in the text: " + shorten(text));
  }

  for (const image of document.images)
    if (!image.complete || !image.naturalWidth) faults.push("picture not shown: " + image.getAttribute("src"));

  for (const code of document.querySelectorAll("pre"))
    cut(code, code.textContent.split("\n").reduce((a, b) => a.length >= b.length ? a : b));
  for (const table of document.querySelectorAll("table"))
    cut(table.parentElement, table.textContent);
  const page = document.documentElement;
  if (page.scrollWidth > window.innerWidth)
    faults.push(`page of ${page.scrollWidth} pixels in a window of ${window.innerWidth}`);
  return { faults, equations: document.querySelectorAll(".math .katex-html").length };
})()
"""


class Browser:
    """Chromium without a window, spoken to by its DevTools protocol over two pipes: messages of JSON that end with a 0 byte."""

    def __init__(self, program, profile):
        to_browser, self.write_end = os.pipe()
        self.read_end, from_browser = os.pipe()

        def pipes_as_3_and_4():
            # by way of high numbers, since 3 and 4 may be among those that are moved
            os.dup2(os.dup2(to_browser, 103), 3)
            os.dup2(os.dup2(from_browser, 104), 4)

        self.process = subprocess.Popen(
            [program, "--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
             "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-extensions",
             "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={profile}", f"--window-size={WIDTH},{HEIGHT}",
             "about:blank"],
            preexec_fn=pipes_as_3_and_4, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.unread, self.number, self.session, self.events = b"", 0, None, []

    def __enter__(self):
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Runtime"):
            self.call(domain + ".enable")
        self.call("Emulation.setDeviceMetricsOverride", width=WIDTH, height=HEIGHT, deviceScaleFactor=1, mobile=False)
        return self

    def __exit__(self, *what):
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def receive(self, until):
        while b"\0" not in self.unread:
            if not select.select([self.read_end], [], [], max(0.0, until - time.monotonic()))[0]:
                raise TimeoutError(f"no answer of the browser in {PATIENCE} s")
            piece = os.read(self.read_end, 1 << 16)
            if not piece:
                raise RuntimeError("the browser has ended")
            self.unread += piece
        message, self.unread = self.unread.split(b"\0", 1)
        message = json.loads(message)
        if "method" in message and message.get("sessionId") == self.session:
            self.events.append(message)
        return message

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.write_end, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + PATIENCE
        while True:
            answer = self.receive(until)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def open(self, url):
        """Returns when the page and all that it asks for is there; self.events: what happened since."""
        self.events = []
        self.call("Page.navigate", url=url)
        until = time.monotonic() + PATIENCE
        while not any(event["method"] == "Page.loadEventFired" for event in self.events):
            self.receive(until)

    def evaluate(self, script):
        answer = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(str(answer["exceptionDetails"]))
        return answer["result"].get("value")

    def picture(self, path):
        size = self.call("Page.getLayoutMetrics")["cssContentSize"]
        clip = {"x": 0, "y": 0, "width": WIDTH, "height": min(size["height"], 4000), "scale": 1}
        data = self.call("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)["data"]
        with open(path, "wb") as f:
            f.write(base64.b64decode(data))


def faults_of_events(events, folder):
    """Files that are missing or elsewhere, and scripts that failed."""
    urls, faults = {}, []
    for event in events:
        p = event["params"]
        if event["method"] == "Network.requestWillBeSent":
            url = urls[p["requestId"]] = p["request"]["url"]
            if urllib.parse.urlsplit(url).scheme not in ("file", "data", "blob"):
                faults.append("asks for " + url)
        elif event["method"] == "Network.loadingFailed":
            name = urllib.parse.unquote(urls.get(p["requestId"], "?")).replace("file://" + folder + "/", "")
            faults.append(f"missing file {name}: {p['errorText']}")
        elif event["method"] == "Runtime.exceptionThrown":
            details = p["exceptionDetails"]
            faults.append("script failed: " + details.get("exception", {}).get("description", details["text"]).split("\n")[0])
    return faults


def pages_of(folder):
    paths = [os.path.relpath(os.path.join(base, name), folder)
             for base, _, names in os.walk(folder) for name in names if name.endswith(".html")]
    return sorted(path for path in paths if not path.startswith("_static"))


def url_of(folder, page):
    return "file://" + urllib.parse.quote(os.path.join(folder, page))


def check(browser, folder):
    faults, equations = [], 0
    for page in pages_of(folder):
        browser.open(url_of(folder, page))
        seen = browser.evaluate(LOOK_AT_PAGE)
        equations += seen["equations"]
        faults += [f"{page}: {fault}" for fault in dict.fromkeys(faults_of_events(browser.events, folder) + seen["faults"])]
    if not equations:
        faults.append("no equation in any page")
    return faults, equations


def check_search(browser, folder):
    browser.open(url_of(folder, "search.html") + "?q=viscosity")
    until = time.monotonic() + 10
    while not browser.evaluate("document.querySelectorAll('#search-results li a').length"):
        if time.monotonic() > until:
            return ["search.html: finds no page with the word viscosity"]
        time.sleep(0.1)
    return []


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--chromium", default="chromium")
    parser.add_argument("--pictures", nargs="+", default=[])
    arguments = parser.parse_args()
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as work:
        folder = os.path.join(work, "a manual, anywhere")
        shutil.copytree(arguments.folder, folder)
        with Browser(arguments.chromium, os.path.join(work, "profile")) as browser:
            faults, equations = check(browser, folder)
            for page in arguments.pictures[1:]:
                browser.open(url_of(folder, page))
                browser.evaluate(LOOK_AT_PAGE)
                browser.picture(os.path.join(arguments.pictures[0], page.replace("/", "_").replace(".html", ".png")))
            faults += check_search(browser, folder)
        print(f"{len(pages_of(folder))} pages, {equations} equations, {time.monotonic() - begin:.1f} s")
    for fault in faults:
        print("FAULT " + fault)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
