"""An editor: a client of pytest-lsp with open files, which keeps what the server tells of them."""

import asyncio
import json
import uuid
from concurrent.futures import Future
from pathlib import Path

from lsprotocol import types
from pygls import uris
from pygls.exceptions import JsonRpcException
from pygls.protocol import default_converter
from pytest_lsp import LanguageClient
from pytest_lsp.client import DEFAULT_CLIENT_FEATURES, register_lsp_features

from buffer import Buffer

# A server that says nothing for so many seconds hangs.
PATIENCE = 60


class Client(LanguageClient):
    """A client that keeps all diagnostics with their versions, and never ends the server by itself."""

    def __init__(self):
        super().__init__(converter_factory=default_converter)
        self.published = []
        self.news = asyncio.Condition()
        self.registrations = []
        # What the server sent and the client could not read.
        self.faults = []
        register_lsp_features(self, {**DEFAULT_CLIENT_FEATURES, **FEATURES})

    async def note(self, where, *news):
        where.extend(news)
        async with self.news:
            self.news.notify_all()

    def report_server_error(self, error, source):
        self.faults.append(f"{source.__name__}: {error}")


async def publish(client: Client, params: types.PublishDiagnosticsParams):
    await client.note(client.published, params)


async def show(client: Client, params: types.ShowMessageParams):
    await client.note(client.messages, params)


async def register(client: Client, params: types.RegistrationParams):
    await client.note(client.registrations, *params.registrations)


FEATURES = {
    types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS: publish,
    types.WINDOW_SHOW_MESSAGE: show,
    types.CLIENT_REGISTER_CAPABILITY: register,
}


def with_markdown():
    """What an editor says of itself that shows Markdown, and nothing else."""
    shown = [types.MarkupKind.Markdown]
    item = types.ClientCompletionItemOptions(documentation_format=shown)
    signature = types.ClientSignatureInformationOptions(documentation_format=shown)
    document = types.TextDocumentClientCapabilities(
        hover=types.HoverClientCapabilities(content_format=shown),
        completion=types.CompletionClientCapabilities(completion_item=item),
        signature_help=types.SignatureHelpClientCapabilities(signature_information=signature),
    )
    return types.ClientCapabilities(text_document=document)


class Editor:
    """One session with one server."""

    def __init__(self, client, folder: Path):
        self.client = client
        self.folder = folder
        self.encoding = "utf-16"
        self.buffers = {}
        self.offered = None

    async def hello(self, capabilities=None, settings=None, **params):
        """Says hello as an editor with these capabilities does."""
        folder = uris.from_fs_path(str(self.folder))
        values = {
            "process_id": None,
            "root_uri": folder,
            "workspace_folders": [types.WorkspaceFolder(uri=folder, name="cell")],
            "initialization_options": settings,
            **params,
        }
        params = types.InitializeParams(capabilities=capabilities or with_markdown(), **values)
        result = await wait(self.client.initialize_session(params))
        self.offered = result.capabilities
        self.encoding = str(getattr(self.offered.position_encoding, "value", self.offered.position_encoding))
        return result

    async def leave(self):
        """Says goodbye; gives the code that the server ends with."""
        await wait(self.client.shutdown_session())
        return self.client._server.returncode

    def uri(self, name):
        return uris.from_fs_path(str(self.folder / name))

    def path(self, uri):
        return Path(uris.to_fs_path(uri))

    def name(self, uri):
        """The name of a file below the folder."""
        return str(self.path(uri).relative_to(self.folder))

    def write(self, name, text):
        """A file on the disk, of which nobody tells the server."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return self.uri(name)

    def open(self, name, text=None, version=1):
        """Opens a file with the text of the disk, or with an unsaved one."""
        if text is None:
            text = (self.folder / name).read_bytes().decode()
        uri = self.uri(name) if ":" not in name else name
        self.buffers[uri] = Buffer(text, self.encoding, version)
        item = types.TextDocumentItem(uri=uri, language_id="arl", version=version, text=text)
        self.client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))
        return uri

    def close(self, uri):
        del self.buffers[uri]
        self.client.text_document_did_close(types.DidCloseTextDocumentParams(text_document=self.document(uri)))

    def document(self, uri):
        return types.TextDocumentIdentifier(uri=uri)

    def text(self, uri):
        return self.buffers[uri].text

    def change(self, uri, changes):
        buffer = self.buffers[uri]
        buffer.version += 1
        document = types.VersionedTextDocumentIdentifier(uri=uri, version=buffer.version)
        params = types.DidChangeTextDocumentParams(text_document=document, content_changes=changes)
        self.client.text_document_did_change(params)

    def set(self, uri, text):
        """Sends the whole text."""
        self.buffers[uri].text = text
        self.change(uri, [types.TextDocumentContentChangeWholeDocument(text=text)])

    def edit(self, uri, *replacements):
        """Sends parts in one message: pairs of words that stand in the text once and what takes their place."""
        buffer, changes = self.buffers[uri], []
        for old, new in replacements:
            assert buffer.text.count(old) == 1, f"{old!r} is not there once"
            start = buffer.text.index(old)
            changes.append(self.part(buffer, start, start + len(old), new))
        self.change(uri, changes)

    def splice(self, uri, start, end, new):
        """Sends one part, by the numbers of its characters."""
        self.change(uri, [self.part(self.buffers[uri], start, end, new)])

    def part(self, buffer, start, end, new):
        change = types.TextDocumentContentChangePartial(range=buffer.range(start, end), text=new)
        buffer.text = buffer.text[:start] + new + buffer.text[end:]
        return change

    def apply(self, edit: types.WorkspaceEdit):
        """Does an edit of the workspace, first on the disk, then in open files. Gives the number of edits by file."""
        assert edit.changes and edit.document_changes is None
        for uri, edits in edit.changes.items():
            if not self.opened(uri):
                path = self.path(uri)
                path.write_bytes(Buffer(path.read_bytes().decode(), self.encoding).applied(edits).encode())
                self.happened(types.FileChangeType.Changed, uri)
        for uri, edits in edit.changes.items():
            if ours := self.opened(uri):
                self.set(ours, self.buffers[ours].applied(edits))
        return {self.name(uri): len(edits) for uri, edits in edit.changes.items()}

    def happened(self, what, *uris):
        """Tells what happened to files on the disk."""
        changes = [types.FileEvent(uri=uri, type=what) for uri in uris]
        self.client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams(changes=changes))

    def opened(self, uri):
        """The address that a file was opened with, however the server writes it."""
        return next((known for known in self.buffers if same_file(known, uri)), None)

    async def until(self, found):
        """Waits until something has been told."""
        async with self.client.news:
            await wait(self.client.news.wait_for(found))
        return found()

    def mark(self):
        """Now, for `first_diagnostics`."""
        return len(self.client.published)

    async def first_diagnostics(self, uri, since=0):
        """The diagnostics of a file that came first since a mark."""
        find = lambda: [one for one in self.client.published[since:] if same_file(one.uri, uri)]
        return list((await self.until(find))[0].diagnostics)

    async def diagnostics(self, uri):
        """The diagnostics of an open file as it is now."""
        version = self.buffers[uri].version
        find = lambda: [one for one in self.client.published if same_file(one.uri, uri) and one.version == version]
        return list((await self.until(find))[-1].diagnostics)

    async def becomes(self, uri, *codes):
        """Waits until what was told last of an open file as it is now has these codes.

        Files that use each other are told of again, also where only the other one changed.
        """

        def last():
            published = [one for one in self.client.published if same_file(one.uri, uri)]
            if not published or published[-1].version != self.buffers[uri].version:
                return None
            return [one.code for one in published[-1].diagnostics]

        await self.until(lambda: last() == list(codes))

    async def codes(self, uri):
        return [one.code for one in await self.diagnostics(uri)]

    async def errors(self, uri):
        """The codes of the mistakes, without warnings."""
        found = await self.diagnostics(uri)
        return [one.code for one in found if one.severity == types.DiagnosticSeverity.Error]

    def at(self, uri, words):
        """The document and the place of the `|`, as most requests want them."""
        return {"text_document": self.document(uri), "position": self.buffers[uri].at(words)}

    def send(self, body):
        """Sends what pygls would not: bytes as they are, or any value as JSON."""
        body = body if isinstance(body, bytes) else json.dumps(body).encode()
        self.client._server.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))

    def request(self, method, params):
        """Sends a request whose parameters may be wrong; gives its answer."""
        number = str(uuid.uuid4())
        answer = self.client.protocol._request_futures[number] = Future()
        self.send({"jsonrpc": "2.0", "id": number, "method": method, "params": params})
        return asyncio.wrap_future(answer)

    async def refused(self, answer):
        """The error that a request ends with."""
        try:
            result = await wait(answer)
        except JsonRpcException as error:
            return error
        raise AssertionError(f"it was not refused: {result}")


def same_file(one, other):
    """Whether two addresses mean the same file: there are several ways to write one."""
    return one == other or uris.to_fs_path(one) == uris.to_fs_path(other) is not None


async def wait(answer):
    """Waits, but not for ever."""
    return await asyncio.wait_for(answer, PATIENCE)
