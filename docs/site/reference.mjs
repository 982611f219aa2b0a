// Pages generated from the program's help and from the headers.
import fs from "node:fs";
import path from "node:path";

const cell = (text) => text.replace(/\|/g, "\\|").replace(/</g, "&lt;");

function optionRow(option) {
  const kinds = { INT: "N", UINT: "N", FLOAT: "X", TEXT: "TEXT" };
  const isOption = option.names[0].startsWith("-");
  const value = option.choices.length ? option.choices.join(option.several ? "," : " or ") : (kinds[option.kind] ?? "");
  const remarks = [
    option.required && isOption ? "required" : "",
    option.several ? "several" : "",
    option.preset ? `default \`${option.preset}\`` : "",
    option.excludes.length ? `not with ${option.excludes.map((name) => `\`${name}\``).join(", ")}` : "",
    option.needs.length ? `only with ${option.needs.map((name) => `\`${name}\``).join(", ")}` : "",
  ].filter(Boolean);
  const names = option.names.map((name) => `\`${name}\``).join(", ");
  return `| ${names} | ${isOption ? cell(value) : ""} | ${cell(option.text)}${remarks.length ? ` *(${remarks.join("; ")})*` : ""} |`;
}

const everywhere = new Set(["--help", "--threads", "--progress", "--overwrite"]);

function commandText(command, level) {
  const lines = [
    `${"#".repeat(level)} ${command.words.join(" ")}`,
    "",
    `${command.summary}.`,
    "",
    "```sh",
    command.usage,
  ];
  lines.push(
    ...command.examples
      .filter((line) => line.startsWith("pcednet"))
      .map((line) => line.replace(/ {3,}(.*)$/, "   # $1")),
    "```",
    "",
  );
  const options = [
    ...command.positionals,
    ...command.options.filter((option) => level === 1 || !everywhere.has(option.names.at(-1))),
  ];
  if (options.length) lines.push("| | value | |", "|---|---|---|", ...options.map(optionRow), "");
  return [lines.join("\n"), ...command.commands.map((one) => commandText(one, level + 1))].join("\n");
}

export function commandPage(program) {
  const common = program.commands[0].options.filter((option) => everywhere.has(option.names.at(-1)));
  return [
    "# Commands and options",
    "",
    "The output of `pcednet COMMAND --help` for every command. [The command line](command-line.md) covers what they have in",
    "common: exit codes, output files, signals.",
    "",
    "## Options of every command",
    "",
    "| | value | |",
    "|---|---|---|",
    ...common.map(optionRow),
    "",
    ...program.commands.map((command) => commandText(command, 2)),
  ].join("\n");
}

/** Comments and declarations of a header, in turn: [{comment, code}]. */
function declarations(text) {
  const body = text.replace(/^#.*\n/gm, "").replace(/^namespace \S+ \{\n|^\}  \/\/ namespace.*\n/gm, "");
  const blocks = [];
  for (const part of body.split(/\n{2,}/)) {
    const lines = part.split("\n").filter((line) => line.trim() !== "");
    if (!lines.length) continue;
    let first = 0;
    while (first < lines.length && lines[first].startsWith("///")) ++first;
    const comment = lines.slice(0, first).map((line) => line.replace(/^\/\/\/ ?/, ""));
    const code = lines.slice(first);
    const inside = blocks.at(-1)?.open ?? 0;
    const depth = (rows) =>
      rows
        .join("")
        .replace(/\/\/.*$/gm, "")
        .split("")
        .reduce((sum, c) => sum + (c === "{") - (c === "}"), 0);
    if (inside > 0) {
      blocks.at(-1).code.push("", ...lines);
      blocks.at(-1).open = inside + depth(lines);
    } else blocks.push({ comment, code, open: depth(code) });
  }
  return blocks;
}

export function cppPage(root) {
  const listing = fs.readFileSync(path.join(root, "cmake/PcednetInstall.cmake"), "utf8");
  const headers = /set\(public_headers([^)]*)\)/.exec(listing)[1].trim().split(/\s+/);
  const lines = [
    "# The C++ library",
    "",
    "The contracts in the installed headers. `pcednet/pcednet.h` includes what a program needs to label points in memory;",
    "`formats/read_cloud.h` and `formats/write_cloud.h` read and write files. The [README](../README.md#in-a-c-program)",
    "shows how to link, [examples/detect_edges.cpp](../examples/detect_edges.cpp) is a whole program, and",
    "[architecture](architecture.md) shows how the rooms fit together.",
    "",
  ];
  for (const header of headers) {
    lines.push(`## ${header}`, "", `[\`#include <pcednet/${header}>\`](../src/pcednet/${header})`, "");
    for (const { comment, code } of declarations(fs.readFileSync(path.join(root, "src/pcednet", header), "utf8"))) {
      lines.push(...comment.map((line) => line.replace(/</g, "&lt;").replace(/^( {0,3}\S)/, "$1")), "");
      if (code.length) lines.push("```cpp", ...code, "```", "");
    }
  }
  return lines.join("\n");
}
