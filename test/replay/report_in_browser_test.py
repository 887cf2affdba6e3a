#!/usr/bin/env python3
"""The page of `replay --report` in a browser: report_in_browser_test.py SIMULATE REPLAY

Skipped unless SDO_LONG_TESTS is set, and where there is no Chromium."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
ATTEMPTS = 5
CONFIG = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "config", "examples")

# What a person does, and what the page says then.
ACTIONS = """
<script>
const results = [];
const say = (name, value) => results.push(name + "=" + value);
const range = () => document.querySelector("#toolbar .range").textContent;
const isPainted = (canvas) => {
  const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return data.some((byte) => byte !== 0);
};
function drag(plot, from, to) {
  const box = plot.getBoundingClientRect();
  const at = (share) => ({bubbles: true, clientX: box.left + share * box.width, clientY: box.top + 100, button: 0,
                          pointerId: 1});
  plot.setPointerCapture = () => {};
  plot.dispatchEvent(new PointerEvent("pointerdown", at(from)));
  plot.dispatchEvent(new PointerEvent("pointermove", at(to)));
  plot.dispatchEvent(new PointerEvent("pointerup", at(to)));
}
addEventListener("error", (event) => say("fault", event.message));
const frames = async (count) => { while (count-- > 0) await new Promise((resolve) => requestAnimationFrame(resolve)); };

async function act() {
  await frames(5);
  const plots = [...document.querySelectorAll(".plot")];
  say("charts", plots.length);
  say("painted", plots.filter((plot) => isPainted(plot.querySelector("canvas"))).length);
  const whole = range();
  say("whole", whole);
  drag(plots[0], 0.4, 0.6);
  say("zoomed", range());
  await frames(3);
  const box = plots[1].getBoundingClientRect();
  plots[1].dispatchEvent(new PointerEvent("pointermove", {clientX: box.left + 300, clientY: box.top + 50}));
  // The keys of all charts tell the values at the pointer.
  say("linked", [...document.querySelectorAll("#states .value")].filter((value) => value.textContent !== "").length);
  plots[0].dispatchEvent(new MouseEvent("dblclick"));
  say("reset", range() === whole);
  HTMLAnchorElement.prototype.click = function () { say("saved_" + this.download.split(".")[1], this.href.length); };
  for (const button of document.querySelectorAll(".grid figure:first-child .export")) button.click();
  const select = document.querySelectorAll("#events select")[1];
  const count = () => document.querySelector("#events .filters .note").textContent.split(" of ")[0];
  say("all", count());
  select.value = "1";
  select.dispatchEvent(new Event("change"));
  say("late", count());
  const isDark = document.documentElement.classList.contains("dark");
  document.querySelector("#toolbar button:last-child").click();
  say("switched", document.documentElement.classList.contains("dark") !== isDark);
  for (const result of results) console.log("RESULT " + result);
  console.log("RESULT done=true");
}
addEventListener("load", () => act());
</script>
"""


def main():
    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if browser is None or not os.environ.get("SDO_LONG_TESTS"):
        print("skipped: it takes SDO_LONG_TESTS and Chromium (apt-get install chromium)")
        return SKIPPED
    simulate, replay = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        example = os.path.join(CONFIG, "ferrante2016_mass_spring")
        files = [os.path.join(example, name + ".yaml") for name in ("scenario", "observer", "gains")]
        bag, page = os.path.join(folder, "run.bag"), os.path.join(folder, "report.html")
        subprocess.run([simulate, files[0], "-o", bag], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([replay, bag, *files, "--truth", "truth", "--report", page], check=True,
                       stdout=subprocess.DEVNULL)
        with open(page, encoding="utf-8") as file:
            text = file.read()
        # Before the page's own script, so that it sees its faults.
        first, rest = text.split('<script type="application/json"')
        with open(page, "w", encoding="utf-8") as file:
            file.write(first + ACTIONS + '<script type="application/json"' + rest)
        # A browser without a screen may end before a script that waits for frames has come to its end.
        for _ in range(ATTEMPTS):
            said = subprocess.run(
                [browser, "--headless=new", "--no-sandbox", "--disable-gpu", "--user-data-dir=" + folder,
                 "--window-size=1280,6000", "--virtual-time-budget=20000", "--enable-logging=stderr",
                 "--screenshot=" + os.path.join(folder, "report.png"), "file://" + page],
                check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, universal_newlines=True,
                timeout=120).stderr
            results = dict(re.findall(r'"RESULT (\w+)=(.*?)", source:', said))
            if results or "Uncaught" in said:
                break
    print(results)
    assert "done" in results, "the page ran into a fault before all was done:\n" + said
    assert "fault" not in results, results["fault"]
    assert int(results["charts"]) == int(results["painted"]) >= 14
    assert results["whole"] != results["zoomed"] and results["reset"] == "true"
    assert int(results["linked"]) >= 10
    assert int(results["saved_png"]) > 5000 and int(results["saved_svg"]) > 2000
    assert int(results["all"]) > int(results["late"]) > 0
    assert results["switched"] == "true"
    return 0


if __name__ == "__main__":
    sys.exit(main())
