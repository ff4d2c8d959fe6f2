// The test view: the cases of the workspace, run by `arl2rs test`.

import { readFile, rm } from "node:fs/promises";
import * as os from "node:os";
import * as path from "node:path";
import * as vscode from "vscode";
import { casesAmong, folderOf, foldersOf } from "./cases";
import { requireCommand } from "./command";
import { type FileCoverage, readLcov } from "./lcov";
import { collect, type Ended } from "./process";
import { type Failure, readReport, type Report } from "./report";
import { firstFolder } from "./settings";

const FILES = "**/*.{arl,out,err,alarm}";
const LEFT_OUT = "**/{node_modules,target}/**";
/** How long to wait for more file changes before searching again, in ms. */
const QUIET = 300;

export class TestView implements vscode.Disposable {
  private readonly controller = vscode.tests.createTestController("arl2rs", "ARL cases");
  private readonly watcher = vscode.workspace.createFileSystemWatcher(FILES, false, true, false);
  private readonly folders = vscode.workspace.onDidChangeWorkspaceFolders(() => this.lookSoon());
  private timer: NodeJS.Timeout | undefined;

  constructor() {
    this.controller.refreshHandler = () => this.look();
    const run = (request: vscode.TestRunRequest, token: vscode.CancellationToken) => this.run(request, token);
    this.controller.createRunProfile("Run", vscode.TestRunProfileKind.Run, run, true);
    const cover = (request: vscode.TestRunRequest, token: vscode.CancellationToken) => this.run(request, token, true);
    const covering = this.controller.createRunProfile("Coverage", vscode.TestRunProfileKind.Coverage, cover, true);
    covering.loadDetailedCoverage = (_, file) =>
      Promise.resolve(file instanceof CoveredFile ? detailsOf(file.told) : []);
    this.watcher.onDidCreate(() => this.lookSoon());
    this.watcher.onDidDelete(() => this.lookSoon());
    this.lookSoon();
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.folders.dispose();
    this.watcher.dispose();
    this.controller.dispose();
  }

  private lookSoon(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.look(), QUIET);
  }

  /** Finds the cases: an item for each folder that has some, with an item for each case. */
  private async look(): Promise<void> {
    const found = await vscode.workspace.findFiles(FILES, LEFT_OUT);
    const local = found.filter((uri) => uri.scheme === "file");
    const named = new Map(local.map((uri) => [vscode.workspace.asRelativePath(uri, true).replaceAll("\\", "/"), uri]));
    const items = new Map<string, vscode.TestItem>();
    for (const name of casesAmong([...named.keys()])) {
      const uri = named.get(name);
      if (uri !== undefined) {
        this.folder(items, name, uri).children.add(this.item(uri, path.posix.basename(name, ".arl")));
      }
    }
    this.controller.items.replace([...items.values()]);
  }

  private folder(items: Map<string, vscode.TestItem>, name: string, uri: vscode.Uri): vscode.TestItem {
    const place = vscode.Uri.joinPath(uri, "..");
    const known = items.get(place.toString());
    if (known !== undefined) {
      return known;
    }
    const item = this.item(place, folderOf(name));
    items.set(place.toString(), item);
    return item;
  }

  private item(uri: vscode.Uri, label: string): vscode.TestItem {
    return this.controller.createTestItem(uri.toString(), label, uri);
  }

  private async run(
    request: vscode.TestRunRequest,
    token: vscode.CancellationToken,
    covers = false,
  ): Promise<void> {
    if (!vscode.workspace.isTrusted) {
      void vscode.window.showInformationMessage("Cases are run in trusted folders only.");
      return;
    }
    const command = await requireCommand();
    if (command === undefined) {
      return;
    }
    await vscode.workspace.saveAll(false);
    const cases = this.wanted(request);
    const run = this.controller.createTestRun(request);
    const lcov = path.join(os.tmpdir(), `arl2rs-${process.pid}-${Date.now()}.info`);
    try {
      cases.forEach((item) => run.started(item));
      const folders = foldersOf(cases.map((item) => slashed(item)));
      if (folders.length > 0) {
        const options = covers ? ["--coverage", lcov] : [];
        conclude(run, cases, await collect(command, ["test", ...folders, ...options], firstFolder(), token));
        if (covers) {
          addCoverage(run, await readFile(lcov, "utf8"));
        }
      }
    } catch (error) {
      cases.forEach((item) => run.errored(item, new vscode.TestMessage(String(error))));
    } finally {
      run.end();
      await rm(lcov, { force: true });
    }
  }

  /** The requested cases. */
  private wanted(request: vscode.TestRunRequest): vscode.TestItem[] {
    const left_out = new Set(request.exclude ?? []);
    const cases: vscode.TestItem[] = [];
    const take = (item: vscode.TestItem): void => {
      if (left_out.has(item) || cases.includes(item)) {
        return;
      }
      if (item.parent === undefined) {
        item.children.forEach(take);
      } else {
        cases.push(item);
      }
    };
    if (request.include === undefined) {
      this.controller.items.forEach(take);
    } else {
      request.include.forEach(take);
    }
    return cases;
  }
}

/** A file with its coverage for the editor. */
class CoveredFile extends vscode.FileCoverage {
  constructor(
    uri: vscode.Uri,
    readonly told: FileCoverage,
  ) {
    const ran = (counts: readonly number[]) =>
      new vscode.TestCoverageCount(counts.filter((count) => count > 0).length, counts.length);
    const functions = told.functions.map((one) => one.count);
    super(uri, ran([...told.lines.values()]), undefined, functions.length > 0 ? ran(functions) : undefined);
  }
}

function addCoverage(run: vscode.TestRun, lcov: string): void {
  for (const told of readLcov(lcov)) {
    run.addCoverage(new CoveredFile(vscode.Uri.file(path.resolve(firstFolder() ?? "", told.file)), told));
  }
}

function detailsOf(told: FileCoverage): vscode.FileCoverageDetail[] {
  const start = (line: number): vscode.Position => new vscode.Position(line - 1, 0);
  const lines = [...told.lines].map(([line, count]) => new vscode.StatementCoverage(count, start(line)));
  const functions = told.functions.map((one) => new vscode.DeclarationCoverage(one.name, one.count, start(one.line)));
  return [...lines, ...functions];
}

/** Reports to the view how the cases ended. The command runs whole folders, so it may report others, too. */
function conclude(run: vscode.TestRun, cases: readonly vscode.TestItem[], ended: Ended): void {
  run.appendOutput(`${ended.err}${ended.out}`.replace(/\r?\n/g, "\r\n"));
  const report = readReport(ended.out);
  if (report.counts === undefined) {
    const why = ended.err.trim() || "arl2rs test ended early.";
    for (const item of cases) {
      if (ended.code === undefined) {
        run.skipped(item);
      } else {
        run.errored(item, new vscode.TestMessage(why));
      }
    }
    return;
  }
  const failures = failuresByFile(report);
  for (const item of cases) {
    const failure = failures.get(slashed(item));
    if (failure === undefined) {
      run.passed(item);
    } else {
      run.failed(item, message(item, failure));
    }
  }
}

function failuresByFile(report: Report): Map<string, Failure> {
  const absolute = (file: string): string => vscode.Uri.file(path.resolve(firstFolder() ?? "", file)).fsPath;
  return new Map(report.failures.map((failure) => [absolute(failure.file).replaceAll("\\", "/"), failure]));
}

function message(item: vscode.TestItem, failure: Failure): vscode.TestMessage {
  const { difference, place } = failure;
  const told =
    difference === undefined
      ? new vscode.TestMessage(failure.message)
      : vscode.TestMessage.diff(failure.message, difference.expected, difference.actual);
  if (item.uri !== undefined) {
    const folder = path.dirname(item.uri.fsPath);
    const uri = place === undefined ? item.uri : vscode.Uri.file(path.resolve(folder, place.file));
    const position = new vscode.Position((place?.line ?? 1) - 1, (place?.column ?? 1) - 1);
    told.location = new vscode.Location(uri, position);
  }
  return told;
}

/** The path of an item, with `/` between its parts. */
function slashed(item: vscode.TestItem): string {
  return (item.uri?.fsPath ?? "").replaceAll("\\", "/");
}
