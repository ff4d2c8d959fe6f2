// Shows the plot of a run beside the program.

import * as vscode from "vscode";

export class PlotView implements vscode.Disposable {
  private panel: vscode.WebviewPanel | undefined;

  /** Shows a plot. Does nothing if the run made none: the run has reported the reason. */
  async show(drawing: vscode.Uri): Promise<void> {
    const bytes = await vscode.workspace.fs.readFile(drawing).then((read) => read, () => undefined);
    if (bytes === undefined) {
      return;
    }
    const panel = this.open();
    panel.title = drawing.path.split("/").at(-1) ?? "Plot";
    panel.webview.html = page(new TextDecoder().decode(bytes));
    panel.reveal(undefined, true);
  }

  dispose(): void {
    this.panel?.dispose();
  }

  private open(): vscode.WebviewPanel {
    if (this.panel === undefined) {
      const where = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
      this.panel = vscode.window.createWebviewPanel("arl2rs.plot", "Plot", where, { enableScripts: false });
      this.panel.onDidDispose(() => (this.panel = undefined));
    }
    return this.panel;
  }
}

/** The plot is embedded in the page itself, so that its tooltips work; scripts are not allowed. */
function page(svg: string): string {
  const drawing = svg.replace(/^\s*<\?xml[^>]*\?>/, "");
  return [
    "<!DOCTYPE html>",
    "<meta charset=\"utf-8\">",
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">",
    "<style>body { background: white; padding: 0 } svg { max-width: 100%; height: auto }</style>",
    drawing,
  ].join("\n");
}
