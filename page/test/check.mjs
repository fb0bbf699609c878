// Opens a page of `cscd view` in headless Chromium and uses it as a person would. Exit status: 0 all is well, 1 something is
// not (one line says what), 77 there is no Chromium.
//
//   node check.mjs FOLDER-WITH-node_modules PAGE [--text EXPECTED] [--pictures FOLDER]
import { mkdirSync } from "node:fs";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { openBrowser, require } from "./browser.mjs";

const [packages, file, ...options] = process.argv.slice(2);
const option = (name) => (options.includes(name) ? options[options.indexOf(name) + 1] : null);

const folder = option("--pictures");
// Software draws: a small window where nobody looks at it.
const { browser, page, complaints, requests } = await openBrowser(packages, folder ? { width: 1100, height: 720 } : { width: 880, height: 560 });

// What the canvas shows, as 160 x 120 pixels of red, green and blue.
const look = () => page.evaluate(() => {
  const small = document.createElement("canvas");
  small.width = 160;
  small.height = 120;
  const context = small.getContext("2d");
  window.cscd.stage.draw();
  context.drawImage(document.getElementById("canvas"), 0, 0, small.width, small.height);
  return Array.from(context.getImageData(0, 0, small.width, small.height).data.filter((_, i) => i % 4 < 3));
});
const different = (a, b) => {
  let count = 0;
  for (let i = 0; i < a.length; i += 3)
    if (Math.max(...[0, 1, 2].map((k) => Math.abs(a[i + k] - b[i + k]))) > 16) ++count;
  return count;
};
const settle = () => page.waitForFunction(() => !window.cscd.stage.flight && !window.cscd.stage.requested);
const clock = () => page.textContent("#clock");
const picture = async (name) => {
  if (!folder) return;
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${basename(file, ".html")}-${name}.png`) });
};

try {
  const opened = Date.now();
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForFunction(() => window.cscd || document.body.classList.contains("failed"));
  require(!(await page.evaluate(() => document.body.classList.contains("failed"))), await page.textContent("#details"));
  await settle();
  const openedIn = Date.now() - opened;
  const said = await page.textContent("#verdict");
  if (option("--text")) require(said.includes(option("--text")), `the verdict does not say "${option("--text")}": ${said}`);
  require((await page.evaluate(() => document.getElementById("list").scrollTop)) === 0, "the list does not open at its top");
  await picture("opening");

  // It opens at what the verdict speaks of first.
  const opening = await page.evaluate(() => {
    const { active, recording, position, mode } = window.cscd, { headline } = active.summary;
    return headline && { at: position, deepest: headline.deepest.interval + headline.deepest.time - recording.clip.first_interval, mode, text: headline.text };
  });
  const named = await page.evaluate(() => {
    const { active, recording, position } = window.cscd, { headline, first_named: first } = active.summary;
    return headline || recording.truths || !first ? null : { interval: first.interval - recording.clip.first_interval, at: Math.floor(position) };
  });
  if (named) require(named.at === named.interval, `the page opens in interval ${named.at} and not at the first contact that the verdict names, in ${named.interval}`);
  if (opening) {
    require(opening.at === opening.deepest, `the page opens at ${opening.at} and not where it is deepest, at ${opening.deepest}`);
    require(opening.mode === "depth", "the page does not open in colours of depth");
    require(said.includes(opening.text) && said.indexOf(opening.text) < said.indexOf(" itself "), `the verdict does not begin with the worst: ${said}`);
  }

  const way = await page.evaluate(() => { const { chosen, stage } = window.cscd; return chosen?.event && { known: Boolean(chosen.event.out), drawn: stage.looks[0].marks.way.visible }; });
  if (way) require(way.known === way.drawn, way.known ? "no arrow shows the way out" : "an arrow shows a way out that is not known");

  // A page without contact shows the surface of every frame, and its camera stays.
  if (await page.evaluate(() => window.cscd.moments.length === 0)) {
    const outside = await page.evaluate(() => {
      const { stage, recording } = window.cscd, point = stage.camera.position.clone();
      let most = 0, seen = 0;
      for (let f = 0; f <= recording.intervals; ++f) {
        window.cscd.seek(f);
        stage.draw();
        for (let v = 0; v < recording.clip.vertices; v += 7) {
          stage.surface.point(v, point).project(stage.camera);
          const reach = Math.max(Math.abs(point.x), Math.abs(point.y));
          most = Math.max(most, reach);
          ++seen;
        }
      }
      window.cscd.open();
      return { most, seen };
    });
    require(outside.seen > 0 && outside.most <= 1, `the surface leaves the picture: it reaches ${outside.most} of the way to its border`);
    require(outside.most > 0.5, `the surface is small: it reaches ${outside.most} of the way to the border`);
    await settle();
  }
  const said_up = await page.evaluate(() => window.cscd.recording.header.up);
  require((await page.textContent("#up")) === `up: ${said_up.axis}`, "the page does not show what is up");
  require((await page.textContent("#up-note")) === (said_up.because ? "" : `up: ${said_up.axis}, because nothing says otherwise`), "the page does not say why that is up");

  const first = await look();
  require(new Set(first).size > 20, "the canvas is empty");
  require(different(first, await look()) === 0, "one view gives two pictures");

  // Whatever is under the pointer has a name: here the triangle whose middle is nearest to the camera.
  const front = await page.evaluate(() => {
    const { stage, recording } = window.cscd, { corners, place, texts } = recording, { camera, canvas, surface } = stage;
    const point = camera.position.clone(), middle = camera.position.clone();
    let nearest = Infinity, found = null;
    for (let t = 0; 3 * t < corners.length; ++t) {
      middle.set(0, 0, 0);
      for (let k = 0; k < 3; ++k) middle.addScaledVector(surface.point(corners[3 * t + k], point), 1 / 3);
      const far = middle.distanceTo(camera.position), { x, y } = middle.project(camera);
      if (far < nearest && Math.abs(x) < 0.5 && Math.abs(y) < 0.3) [nearest, found] = [far, { x: ((x + 1) / 2) * canvas.clientWidth, y: ((1 - y) / 2) * canvas.clientHeight, name: texts[place[t]] }];
    }
    return found;
  });
  await page.locator("#canvas").hover({ position: front, force: true });
  await page.waitForFunction(() => document.getElementById("pointed").textContent !== "");
  require((await page.textContent("#pointed")).startsWith(front.name), `the pointer names ${await page.textContent("#pointed")} where ${front.name} is nearest`);

  // The slider and the keys change the frame.
  const moments = await page.evaluate(() => window.cscd.moments.length);
  const before = await clock();
  await page.click("#whole");
  await settle();
  const whole = await look();
  await page.locator("#slider").evaluate((slider) => {
    slider.value = String(Number(slider.max) * 0.8);
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  });
  require((await clock()) !== before, "the slider does not change the frame");
  require(different(whole, await look()) > 20, "the slider does not move the surface");
  await page.focus("#canvas");
  await page.keyboard.press("Home");
  require((await clock()).startsWith(await page.evaluate(() => `frame ${window.cscd.recording.clip.frame_number[0].toFixed(2)}`)), `Home leads to ${await clock()}`);
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Shift+ArrowRight");
  require((await page.evaluate(() => window.cscd.position)) === Math.min(11, await page.evaluate(() => window.cscd.recording.intervals)), "arrows do not step frames");

  // Playing moves, and pausing stops.
  await page.keyboard.press(" ");
  await page.waitForTimeout(1500);
  const times = await page.evaluate(() => window.cscd.stage.frameTimes.slice(-60));
  await page.keyboard.press(" ");
  const paused = await clock();
  require((await page.evaluate(() => window.cscd.position)) !== 11, "the clip does not play");
  await page.waitForTimeout(200);
  require((await clock()) === paused, "the clip does not pause");
  const gaps = times.slice(1).map((t, i) => t.at - times[i].at).sort((a, b) => a - b);
  const scripts = times.map((t) => t.cpu).sort((a, b) => a - b);

  // Every way of colouring shows colours of its own.
  // Those that show the engine are folded away, unless a strategy was named.
  const engine = await page.evaluate(() => ({ open: document.getElementById("engine").open, asked: window.cscd.recording.header.engine_colours }));
  require(engine.open === engine.asked, `the engine's colours are ${engine.open ? "shown" : "hidden"}`);
  if (!engine.open && (await page.locator("#engine").isVisible())) await page.click("#engine summary");
  const modes = await page.locator("#modes button, #engine-modes button").all();
  const pictures = [];
  for (const mode of modes) {
    await mode.click();
    pictures.push(await look());
    await picture(`colour-${await mode.getAttribute("value")}`);
  }
  const values = await Promise.all(modes.map((mode) => mode.getAttribute("value")));
  const seen = await page.evaluate(() => { const { active } = window.cscd; return { patch: active.has_patches, cover1: active.covers > 1, atomic: active.has_clusters, place: true }; });
  for (const name of ["atomic", "place", "patch", "cover1"])
    if (seen[name] && values.includes(name)) require(different(pictures[0], pictures[values.indexOf(name)]) > 50, `colour by ${name} changes nothing`);

  // Observers are points and segments of the interval's clusters.
  if (await page.evaluate(() => window.cscd.active.observers.length > 0)) {
    await page.evaluate(() => window.cscd.setMode("cluster"));
    const without = await look();
    await page.click("#show-observers");
    const shown = await page.evaluate(() => {
      const { active, stage } = window.cscd, { offset } = active.observers[0], interval = window.cscd.interval();
      return { points: stage.looks[0].marks.observers.geometry.getAttribute("position").count, least: offset[interval + 1] - offset[interval] };
    });
    require(shown.least > 0 && shown.points >= shown.least, `${shown.points} points are shown of ${shown.least} observers`);
    require(different(without, await look()) > 0, "observers change nothing");
    await picture("observers");
    await page.click("#show-observers");
  }

  // A contact in the list moves the camera to it, at its own time.
  if (moments > 0) {
    await page.keyboard.press("1");
    await page.click("#whole");
    await settle();
    const far = await page.evaluate(() => window.cscd.stage.camera.position.toArray());
    // Every interval in which something meets is a moment of some pair, and a pair's heading says how many it has.
    const group = page.locator("#list > details").nth(Math.min(1, (await page.locator("#list > details").count()) - 1));
    if (!(await group.evaluate((box) => box.open))) await group.locator("> summary").click();
    const row = group.locator("> button").last();
    await row.waitFor();
    const heading = await group.locator("> summary").textContent(), listed = await group.locator("> button").count();
    require(listed === 1 ? !heading.includes(" moments, ") : heading.includes(`${listed.toLocaleString("en")} moments, `), `a pair with ${listed} moments says: ${heading}`);
    const held = await page.evaluate(() => new Set(Array.from(window.cscd.active.groups.values()).flat().map(({ interval }) => interval)).size);
    require(held === moments, `${held} of ${moments} moments belong to a pair`);
    // Folds at joints come last.
    const order = await page.evaluate(() => {
      const { list, active } = window.cscd, keys = Array.from(list.groups.keys()), boxes = Array.from(document.querySelectorAll("#list > details"));
      return boxes.map((box) => active.folds.has(keys.find((key) => list.groups.get(key).details === box)));
    });
    require(order.lastIndexOf(false) < order.indexOf(true) || !order.includes(true), `folds at joints are not listed last: ${order}`);
    await page.emulateMedia({ reducedMotion: null });  // one flight of the camera is looked at
    await row.click();
    await settle();
    await page.emulateMedia({ reducedMotion: "reduce" });
    const arrived = await page.evaluate(() => {
      const { stage, chosen } = window.cscd, point = window.cscd.pointOf(chosen);
      return { moved: stage.camera.position.toArray(), off: stage.controls.target.distanceTo(point), radius: stage.whole.radius, interval: window.cscd.interval() };
    });
    require(Math.hypot(...far.map((x, i) => x - arrived.moved[i])) > 0.1 * arrived.radius, "a contact in the list does not move the camera");
    require(arrived.off < 0.01 * arrived.radius, "the camera does not look at the contact");
    require(different(whole, await look()) > 100, "a contact in the list does not change the picture");
    require(await row.getAttribute("aria-current") || (await page.locator("#list .contacts button[aria-current]").count()) > 0, "the list does not mark the chosen contact");
    const one = page.locator("#list .contacts button").last();
    if (await one.count()) {
      require(!(await one.isVisible()), "the contacts of a moment are not folded");
      await page.click("#list .contacts summary");
      await one.click();
      require((await one.getAttribute("aria-current")) === "true", "the list does not mark a chosen contact");
      await settle();
      const pinned = await page.evaluate(() => [window.cscd.pinned.t, window.cscd.recording.strategies[window.cscd.strategy].contact_time[window.cscd.chosen.contact] / 65535]);
      require(pinned[0] === pinned[1], "the surface is not shown at the contact's time");
    }
    await picture("contact");
  }

  // Another strategy has colours of its own.
  if ((await page.locator("#strategies button").count()) > 1) {
    await page.click("#whole");
    await settle();
    await page.evaluate(() => window.cscd.setMode("cluster"));
    const one = await look();
    await page.focus("#canvas");
    await page.keyboard.press("s");
    require(different(one, await look()) > 50, "another strategy changes no colour");
    await page.click("#together");
    require((await page.locator(".pane").count()) === (await page.locator("#strategies button").count()), "not every strategy has a pane");
    await picture("together");
    await page.click("#together");
  }

  // What lies in itself is listed, and a click leads to where it is deepest, in colours of its depth.
  const wayOut = await page.evaluate(() => {
    const { recording, active } = window.cscd, worst = recording.events.find(({ number }) => number === active.summary.headline?.event);
    return { mover: worst?.out ? worst.name : null, said: document.getElementById("what-to-do").textContent };
  });
  require(wayOut.mover === null ? !wayOut.said.includes("move") : wayOut.said.includes(`move ${wayOut.mover} `), `what to do: ${JSON.stringify(wayOut)}`);
  const events = await page.evaluate(() => window.cscd.recording.events.map(({ deepest, time }) => deepest + time));
  require((await page.locator("button.event").count()) === Math.min(10, events.length), "not every event is listed");
  if (events.length > 0) {
    await page.locator("button.event").last().click();
    await settle();
    require((await page.evaluate(() => window.cscd.position)) === events[Math.min(10, events.length) - 1], "an event does not lead to its deepest frame");
    const deep = await look();
    await picture("event");
    // The legend says how deep its colours are, up to the depth that the verdict names, and whether any vertex of the clip is deeper.
    const scale = await page.evaluate(() => {
      const { recording } = window.cscd, named = recording.strategies[0].summary.headline?.depth.at_least, cm = recording.header.import?.centimetres_per_unit ?? 0, numbers = Array.from(document.querySelectorAll("#legend .scale b"), (b) => b.textContent);
      const last = numbers.at(-1)?.replace("\u2265 ", ""), factor = { m: 100, cm: 1, mm: 0.1 }[last?.split(" ")[1]];
      const deepest = recording.insideDepth.reduce((a, b) => Math.max(a, b), 0), most = named || deepest, marked = numbers.at(-1)?.startsWith("\u2265");
      return { numbers, last: parseFloat(last?.replaceAll(",", "")) * (factor ?? 1), most: most * (cm || 1), marked: deepest > 1.01 * most ? marked : deepest > most || !marked, unit: (cm > 0) === (factor !== undefined) };
    });
    require(scale.numbers[0] === "0" && scale.numbers.length === 3 && Math.abs(scale.last - scale.most) <= 0.006 * scale.most && scale.marked && (scale.unit || scale.most === 0), `the depths' scale says ${JSON.stringify(scale)}`);
    // Its curves are drawn, closed or not, and those of other events with them. The last pose starts no interval and has none.
    const curves = await page.evaluate(() => {
      const { recording, chosen, stage } = window.cscd, { curveOffset, pointOffset, curveEvent } = recording, interval = window.cscd.interval();
      const drawn = (name) => (stage.looks[0].marks[name].visible ? stage.looks[0].marks[name].geometry.attributes.instanceStart.count : 0);
      let all = 0, own = 0;
      for (let c = curveOffset[interval]; c < curveOffset[interval + 1]; ++c) {
        all += pointOffset[c + 1] - pointOffset[c] - 1;
        if (curveEvent[c] === chosen.event.number) own += pointOffset[c + 1] - pointOffset[c] - 1;
      }
      return { all, own, drawn: drawn("crossings"), chosen: drawn("first"), isLast: chosen.event.time === 1 };
    });
    require((curves.own > 0 || curves.isLast) && curves.drawn === curves.all - curves.own && curves.chosen === curves.own, `curves of an event are not drawn: ${JSON.stringify(curves)}`);
    await page.locator("#modes button[value=place], #modes button[value=often]").first().click();
    require(different(deep, await look()) > 0, "an event is not coloured by its depth");
  }

  // Names from files are text.
  require((await page.locator("img, iframe, object, embed, link").count()) === 0, "a name became an element");

  await page.click("#theme");
  await picture("other-theme");
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForFunction(() => document.documentElement.scrollWidth <= window.innerWidth, null, { timeout: 10000 })
    .catch(() => { throw new Error("the page is wider than a phone"); });
  await picture("phone");

  require(complaints.length === 0, `the browser complains: ${complaints[0]}`);
  require(requests.length === 1, `the page asks for ${requests[1]}`);
  // A page of several clips shows another one by its name.
  const clips = page.locator("#clips option");
  if ((await clips.count()) > 1) {
    const other = page.locator(`#clips option:not([value="${await page.locator("#clips").inputValue()}"])`).first();
    const title = (await other.textContent()).slice(2).replace(/, [^,]* deep$/, "");
    await page.selectOption("#clips", await other.getAttribute("value"));
    await page.waitForFunction((name) => window.cscd && document.getElementById("verdict").textContent.includes(`clip '${name}'`), title)
      .catch(() => { throw new Error(`the clip ${title} is not shown`); });
    await picture("other-clip");
  }
  console.log(JSON.stringify({
    page: basename(file), opened_ms: openedIn, moments, frame_ms: gaps[Math.floor(gaps.length / 2)],
    script_ms: scripts[Math.floor(scripts.length / 2)], frames: times.length,
  }));
} catch (error) {
  console.log(`${file}: ${error.message}`);
  process.exitCode = 1;
} finally {
  await browser.close();
}
