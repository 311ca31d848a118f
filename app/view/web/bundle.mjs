// Makes the page of `drape view`, and what draws the plots of compare.html, and puts them into a C++ source.
//   node bundle.mjs PAGES.cpp      beside node_modules; PAGES.cpp: the functions of app/view/page_template.h
import { build } from "esbuild";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url)), [, , out] = process.argv;

// { text, inputs }: inputs are the files that it was made of.
async function bundled(entry, extra = {}) {
  const result = await build({
    entryPoints: [join(here, entry)], absWorkingDir: here, bundle: true, minify: true, write: false, metafile: true, target: "es2022",
    legalComments: "none", ...extra,
  });
  return { text: result.outputFiles[0].text.trim(), inputs: Object.keys(result.metafile.inputs) };
}

// What the licences of the bundled packages ask for: their texts go with them.
function licences(inputs) {
  const { packages } = JSON.parse(readFileSync(join(here, "package-lock.json"), "utf8"));
  const used = Object.entries(packages).filter(([path]) => path !== "" && inputs.some((file) => file.startsWith(path + "/")));
  if (used.length === 0) throw new Error("no package was found among what was bundled");
  return used.map(([path, { version }]) => {
    const file = readdirSync(join(here, path)).find((name) => /^licen[sc]e/i.test(name));
    const text = readFileSync(join(here, path, file), "utf8").trim();
    return `/*! ${path.replace("node_modules/", "")} ${version}\n${text.replaceAll("*/", "* /")} */\n`;
  }).join("");
}

async function script_of(entry) {
  const { text, inputs } = await bundled(entry, { format: "iife" }), script = licences(inputs) + text;
  if (/<\/script|<!--/i.test(script)) throw new Error(`${entry}: the script would end itself`);
  return script;
}

// A C++ function that returns the text, in pieces, because compilers bound the length of one.
function function_of(name, text) {
  const mark = "drape_page", pieces = [];
  if (text.includes(`)${mark}"`)) throw new Error(`${name}: the text has the mark that ends it`);
  const characters = [...text];
  for (let i = 0; i < characters.length; i += 8000) pieces.push(`R"${mark}(${characters.slice(i, i + 8000).join("")})${mark}"`);
  return `std::string_view ${name}() {\n  static constexpr char text[] =\n${pieces.join("\n")};\n  return {text, sizeof text - 1};\n}\n`;
}

const script = await script_of("src/main.js"), style = (await bundled("page.css")).text;
const page = readFileSync(join(here, "page.html"), "utf8").replace("@@STYLE@@", () => style).replace("@@SCRIPT@@", () => script);
const functions = [
  function_of("page_template", page),
  function_of("plot_style", (await bundled("compare.css")).text),
  function_of("plot_script", await script_of("src/compare.js")),
];
writeFileSync(out, `// Made by app/view/web/bundle.mjs.\n#include "app/view/page_template.h"\n\nnamespace drape::app {\n
${functions.join("\n")}\n}  // namespace drape::app\n`);
