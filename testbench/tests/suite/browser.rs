//! The pages as a browser shows them: nothing on the console, and no text outside its box, on a desk and on a telephone.

use std::fs;
use std::path::Path;
use std::process::Command;

use golden::design::Design;

use crate::support::designs::design_file;
use crate::support::{sptfra, workspace};

/// What the page is asked once it is there; names of dots are shown while they are measured.
const QUESTIONS: &str = r#"<script>
addEventListener("load", () => {
  const wrong = [];
  if (document.documentElement.scrollWidth > innerWidth)
    wrong.push(`the page is ${document.documentElement.scrollWidth} wide`);
  const texts = document.querySelectorAll("svg text");
  for (const text of texts) {
    text.style.display = "inline";
    const [own, box] = [text, text.ownerSVGElement].map(element => element.getBoundingClientRect());
    const slack = 1.5;
    if (own.left < box.left - slack || own.right > box.right + slack || own.top < box.top - slack
        || own.bottom > box.bottom + slack) wrong.push(`outside its picture: ${text.textContent}`);
    if (own.height < 10) wrong.push(`${own.height} px high, too small to read: ${text.textContent}`);
  }
  for (const element of document.querySelectorAll("p, h1, h2, h3, figure, figcaption, td, th"))
    if (element.scrollWidth > element.clientWidth + 1 && getComputedStyle(element).overflowX === "visible")
      wrong.push(`outside its box: ${element.textContent.slice(0, 60)}`);
  // A desk has room for every table; on a telephone they move sideways, and the page says so.
  const wide = [...document.querySelectorAll(".wide")].filter(element => element.scrollWidth > element.clientWidth + 1);
  if (innerWidth >= 1280) for (const element of wide)
    wrong.push(`${element.scrollWidth - element.clientWidth} px of a table are cut off: ${element.textContent.slice(0, 60)}`);
  else if (wide.length && document.querySelector(".narrow") && getComputedStyle(document.querySelector(".narrow")).display === "none")
    wrong.push("nothing says that tables move sideways");
  parent.postMessage({ width: innerWidth, texts: texts.length, wrong: wrong.join("\n") }, "*");
});
</script></body>"#;

/// What shows the page in a frame, since a window is never as narrow as a telephone, and keeps its answers.
const FRAME: &str = r#"<!DOCTYPE html><html><body><script>
addEventListener("message", ({ data }) => Object.assign(document.body.dataset, data));
</script><iframe src="asked.html" style="border: 0; width: WIDTHpx; height: 900px"></iframe></body></html>"#;

/// The browser's program, by any of its names.
fn browser() -> &'static str {
    let there = |name: &&str| Command::new(name).arg("--version").output().is_ok();
    ["chromium", "chromium-browser", "google-chrome"].into_iter().find(there).expect("a browser: run `make test-tools`")
}

/// Opens a page in a frame of a width, from the folder in which it has its files; what is wrong with it, and what the console
/// says.
pub fn wrong(page: &str, folder: &Path, width: u32) -> Vec<String> {
    fs::write(folder.join("asked.html"), page.replace("</body>", QUESTIONS)).expect("writable");
    let file = folder.join("frame.html");
    fs::write(&file, FRAME.replace("WIDTH", &width.to_string())).expect("writable");
    let mut browser = Command::new(browser());
    browser.args(["--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--dump-dom"]);
    let profile = tempfile::tempdir().expect("a folder");
    browser.arg(format!("--user-data-dir={}", profile.path().display()));
    // Long enough for the answers, in the browser's own time.
    browser.args(["--window-size=1400,1000", "--virtual-time-budget=5000"]).arg(format!("file://{}", file.display()));
    let output = browser.output().expect("starts");
    fs::remove_file(file).and(fs::remove_file(folder.join("asked.html"))).expect("removable");
    let shown = String::from_utf8_lossy(&output.stdout).into_owned();
    let value = |name: &str| {
        let (_, rest) = shown.split_once(&format!("data-{name}=\"")).unwrap_or_else(|| panic!("no {name}: {shown}"));
        rest.split('"').next().expect("a value").to_owned()
    };
    assert_eq!(value("width"), width.to_string(), "the frame's width");
    let texts = value("texts").parse::<usize>().expect("a number");
    assert!(texts > 20 || !page.contains("<svg"), "the pictures have text: {texts}");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let console = said.lines().filter(|line| line.contains(":CONSOLE")).map(str::to_owned);
    value("wrong").lines().map(str::to_owned).chain(console).collect()
}

fn report(folder: &Path) -> String {
    let out = folder.join("out");
    let mut sweep = Command::new(sptfra());
    let designs =
        ["sensor1-fast", "sensor1-reduced", "paper", "sensor1-wide", "sensor2-reduced", "sensor2-wide", "sensor2-f3"];
    let scenes = ["sensor1-tilted", "two-contacts", "sensor2-held", "sensor2-punch"];
    sweep.arg("sweep").args(designs.map(design_file));
    sweep.arg("--scene").args(scenes.map(|name| workspace(&format!("scenes/{name}.toml"))));
    sweep.args(["--kinds", "1"]);
    let output = sweep.arg("--out").arg(&out).output().expect("starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    fs::read_to_string(out.join("report.html")).expect("written")
}

#[test]
fn the_report_fits_a_desk_and_a_telephone() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = report(folder.path());
    // What it concludes, and from what it does not: two contacts that are pushed against each other.
    for (part, times) in [
        ("recommended: no filter", 2),
        ("tells nothing of either", 1),
        // What is held, one body, tells of sensor 2, and what errs least there is not what is least bad under a punch.
        ("recommended: no filter, reduced plan, joint, 128 units, general", 1),
        // Of one frame of each kind the hardest decides: on sensor 1 the line search's error is the least there.
        ("recommended: no filter, reduced plan, line, 8 lanes", 1),
        ("averaged over: sensor2-held, sensor2-punch, kinds", 1),
        ("Scene kinds", 2),
        ("href=\"recommended/sensor2_wide_recommended.toml\"", 1),
    ] {
        assert_eq!(page.matches(part).count(), times, "{part}");
    }
    // Whole designs, with the weights that they name.
    let recommended = folder.path().join("out/recommended/sensor2_wide_recommended.toml");
    let design = Design::load(&recommended).expect("a design");
    assert!(design.algorithm.joint.correction.is_some() && page.contains(&format!("{} lanes", design.hardware.lanes)));
    // Tables are measured as they are once they were opened.
    let page = page.replace("<details>", "<details open>");
    for width in [1280, 400] {
        let wrong = wrong(&page, folder.path(), width);
        assert!(wrong.is_empty(), "{width} wide:\n{}", wrong.join("\n"));
    }
    // A table that is too wide is found on a desk, and on a telephone if nothing says that it moves.
    let wide = page.replace("</style>", "td { min-width: 9rem; }</style>");
    assert!(wrong(&wide, folder.path(), 1280).concat().contains("of a table are cut off"));
    let silent = page.replace("</style>", ".narrow { display: none !important; }</style>");
    assert!(wrong(&silent, folder.path(), 400).concat().contains("nothing says that tables move"));
    // The questions find what is wrong.
    let broken = page
        .replacen("<h1>", "<script>console.error('broken')</script><h1>", 1)
        .replacen("</h1>", "</h1><p style=\"width: 2em\">incomprehensibilities</p>", 1)
        .replacen("text-anchor=\"middle\"", "text-anchor=\"middle\" dx=\"2000\"", 1);
    let found = wrong(&broken, folder.path(), 1280).join("\n");
    for part in ["broken", "outside its box: incompre", "outside its picture: "] {
        assert!(found.contains(part), "{part}: {found}");
    }
}
