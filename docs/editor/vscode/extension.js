// Starts `stickslip lsp` for decks.
const { workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

exports.activate = () => {
  const command = workspace.getConfiguration("stickslip").get("program", "stickslip");
  client = new LanguageClient(
    "stickslip",
    "stickslip",
    { command, args: ["lsp"] },
    {
      documentSelector: [{ language: "stickslip" }],
      synchronize: { fileEvents: workspace.createFileSystemWatcher("**/*.{inp,inc,dat,txt}") },
    },
  );
  return client.start();
};

exports.deactivate = () => client?.stop();
