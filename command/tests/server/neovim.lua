-- A program typed in Neovim with its own client: what comes is printed, a line each.
vim.o.swapfile = false
local command, file = vim.env.ARL2RS, vim.env.ARL_FILE
vim.cmd("edit " .. vim.fn.fnameescape(file))
local buffer = vim.api.nvim_get_current_buf()
local client = vim.lsp.start_client({
  name = "arl2rs",
  cmd = { command, "lsp" },
  root_dir = vim.fn.fnamemodify(file, ":h"),
})
vim.lsp.buf_attach_client(buffer, client)

local function say(...) io.stdout:write(table.concat({ ... }, " "), "\n") end

-- Waits until something is so; the test ends where it never is.
local function wait(what, is_so)
  if not vim.wait(20000, is_so, 20) then
    say("never:", what)
    vim.cmd("cquit")
  end
end

local function ask(method, params)
  local answers = vim.lsp.buf_request_sync(buffer, method, params, 20000)
  local answer = answers and answers[client]
  if answer == nil or answer.err then
    say("no answer:", method, vim.inspect(answer))
    vim.cmd("cquit")
  end
  return answer.result
end

local function at(line, column)
  local document = { uri = vim.uri_from_bufnr(buffer) }
  return { textDocument = document, position = { line = line, character = column } }
end

wait("a client", function() return vim.lsp.get_client_by_id(client) ~= nil end)
wait("the first mistake", function() return #vim.diagnostic.get(buffer) == 1 end)
local first = vim.diagnostic.get(buffer)[1]
say("mistake", first.code, first.lnum)

-- The quick fix, applied by Neovim.
local params = at(2, 5)
params.range = { start = params.position, ["end"] = params.position }
params.context = { diagnostics = {} }
local fixes = ask("textDocument/codeAction", params)
vim.lsp.util.apply_workspace_edit(fixes[1].edit, "utf-16")
wait("no mistake", function() return #vim.diagnostic.get(buffer) == 0 end)
say("line", vim.api.nvim_buf_get_lines(buffer, 2, 3, false)[1])

-- Typing goes on.
vim.api.nvim_buf_set_lines(buffer, 3, 3, false, { "    movej ho" })
local items = ask("textDocument/completion", at(3, 12))
local labels = {}
for _, item in ipairs(items.items or items) do
  if item.label:sub(1, 2) == "ho" then labels[#labels + 1] = item.label end
end
say("offered", table.concat(labels, " "))
vim.api.nvim_buf_set_lines(buffer, 3, 4, false, { "    movej home,vp:50%" })

say("hover", (ask("textDocument/hover", at(3, 11)).contents.value:gsub("\n.*$", ""):gsub("`", "'")))

local rename = at(0, 7)
rename.newName = "rest"
vim.lsp.util.apply_workspace_edit(ask("textDocument/rename", rename), "utf-16")
say("line", vim.api.nvim_buf_get_lines(buffer, 3, 4, false)[1])

local format = { textDocument = at(0, 0).textDocument, options = { tabSize = 4, insertSpaces = true } }
vim.lsp.util.apply_text_edits(ask("textDocument/formatting", format), buffer, "utf-16")
say("line", vim.api.nvim_buf_get_lines(buffer, 3, 4, false)[1])
vim.lsp.stop_client(client)
vim.cmd("qall!")
