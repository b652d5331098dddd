//! The language server: it answers messages of the editor in their order, and sends diagnostics when the typing pauses.

use super::checks::{self, Check, Fix, Job, Outcome};
use super::completion::{completion, with_documentation};
use super::files::path_of;
use super::hover::hover;
use super::navigation::{changeable, definitions, references, rename};
use super::outline::outline;
use super::workspace::{Place, Workspace};
use crate::diagnostics::{Code, Interrupt};
use crossbeam_channel::{Receiver, Sender, after, never, select};
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, Response};
use lsp_types::notification::{self, Notification as _};
use lsp_types::request::{self, Request as _};
use lsp_types::{
    CodeAction, CodeActionKind, CodeActionOrCommand, CodeActionParams,
    CodeActionProviderCapability, CompletionOptions, Diagnostic, GotoDefinitionResponse, Hover,
    HoverContents, HoverProviderCapability, MarkupContent, MarkupKind, NumberOrString, OneOf,
    Position, PrepareRenameResponse, PublishDiagnosticsParams, Range, RenameOptions, SaveOptions,
    ServerCapabilities, TextDocumentPositionParams, TextDocumentSyncCapability,
    TextDocumentSyncKind, TextDocumentSyncOptions, TextDocumentSyncSaveOptions, TextEdit, Url,
    WorkDoneProgressOptions, WorkspaceEdit,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Pause of the typing after which a deck is checked.
const PAUSE: Duration = Duration::from_millis(200);

/// Functions and data of the program that the server uses.
#[derive(Debug, Clone, Copy)]
pub struct Program {
    /// Function that reads a deck as `stickslip check` does.
    pub check: Check,
    /// Function that returns the text of `stickslip explain` about a code.
    pub explain: fn(Code) -> String,
    /// Version of the program.
    pub version: &'static str,
}

/// Serves an editor on standard input and output until the session ends; returns whether the session ended with a
/// shutdown request.
///
/// # Errors
/// The connection is broken, or a message breaks the protocol.
pub fn serve(program: Program) -> Result<bool, String> {
    let (connection, threads) = Connection::stdio();
    let served = connected(program, &connection);
    drop(connection);
    match served {
        Ok(is_in_order) => threads
            .join()
            .map(|()| is_in_order)
            .map_err(|e| e.to_string()),
        Err(error) => Err(error),
    }
}

/// Serves an editor on a connection.
fn connected(program: Program, connection: &Connection) -> Result<bool, String> {
    let (id, _) = match connection.initialize_start() {
        Ok(begun) => begun,
        Err(error) if error.channel_is_disconnected() => return Ok(false),
        Err(error) => return Err(error.to_string()),
    };
    let capabilities = json!({
        "capabilities": capabilities(),
        "serverInfo": {"name": "stickslip", "version": program.version},
    });
    connection
        .initialize_finish(id, capabilities)
        .map_err(|error| error.to_string())?;
    let (jobs, outcomes) = checks::start(program.check);
    let mut server = Server {
        program,
        out: connection.sender.clone(),
        workspace: Workspace::default(),
        jobs,
        running: None,
        waiting: BTreeMap::new(),
        shown: HashMap::new(),
    };
    server.serve(connection, &outcomes)
}

fn capabilities() -> ServerCapabilities {
    let letters = ["*", ",", "=", "<", "."];
    ServerCapabilities {
        text_document_sync: Some(TextDocumentSyncCapability::Options(
            TextDocumentSyncOptions {
                open_close: Some(true),
                change: Some(TextDocumentSyncKind::INCREMENTAL),
                save: Some(TextDocumentSyncSaveOptions::SaveOptions(
                    SaveOptions::default(),
                )),
                ..TextDocumentSyncOptions::default()
            },
        )),
        completion_provider: Some(CompletionOptions {
            resolve_provider: Some(true),
            trigger_characters: Some(letters.map(str::to_owned).to_vec()),
            ..CompletionOptions::default()
        }),
        hover_provider: Some(HoverProviderCapability::Simple(true)),
        definition_provider: Some(OneOf::Left(true)),
        references_provider: Some(OneOf::Left(true)),
        document_symbol_provider: Some(OneOf::Left(true)),
        rename_provider: Some(OneOf::Right(RenameOptions {
            prepare_provider: Some(true),
            work_done_progress_options: WorkDoneProgressOptions::default(),
        })),
        code_action_provider: Some(CodeActionProviderCapability::Simple(true)),
        ..ServerCapabilities::default()
    }
}

struct Server {
    program: Program,
    out: Sender<Message>,
    workspace: Workspace,
    jobs: Sender<Job>,
    /// Main file of the deck that is being checked, and the signal that ends the check.
    running: Option<(PathBuf, Interrupt)>,
    /// Decks that wait for a check, with the time at which the check is due.
    waiting: BTreeMap<PathBuf, Instant>,
    /// Diagnostics that the editor has, by deck and file.
    shown: HashMap<PathBuf, BTreeMap<PathBuf, Vec<Diagnostic>>>,
}

impl Server {
    fn serve(
        &mut self,
        connection: &Connection,
        outcomes: &Receiver<Outcome>,
    ) -> Result<bool, String> {
        loop {
            self.start_check();
            let first = self.waiting.values().min();
            let pause = match first.filter(|_| self.running.is_none()) {
                Some(first) => after(first.saturating_duration_since(Instant::now())),
                None => never(),
            };
            select! {
                recv(connection.receiver) -> message => match message {
                    Ok(Message::Request(request)) => {
                        if connection.handle_shutdown(&request).map_err(|e| e.to_string())? {
                            return Ok(true);
                        }
                        let response = self.answer(request);
                        self.send(Message::Response(response));
                    }
                    Ok(Message::Notification(one)) if one.method == notification::Exit::METHOD => {
                        return Ok(false);
                    }
                    Ok(Message::Notification(one)) => self.notice(one),
                    Ok(Message::Response(_)) => {}
                    Err(_) => return Ok(false),
                },
                recv(outcomes) -> outcome => {
                    if let Ok(outcome) = outcome {
                        self.running = None;
                        self.show(outcome);
                    }
                }
                recv(pause) -> _ => {}
            }
        }
    }

    fn send(&self, message: Message) {
        // an editor that is gone gets nothing
        let _ = self.out.send(message);
    }

    /// Starts the check of the deck that has waited longest, if this check is due and no other deck is being checked.
    fn start_check(&mut self) {
        let now = Instant::now();
        let due = self.waiting.iter().filter(|(_, when)| **when <= now);
        let first = due
            .min_by_key(|(_, when)| **when)
            .map(|(root, _)| root.clone());
        let (Some(root), None) = (first, &self.running) else {
            return;
        };
        self.waiting.remove(&root);
        self.workspace.files.forget_changed();
        let interrupt = Interrupt::default();
        let open = self.workspace.files.open_paths();
        let files = &self.workspace.files;
        let addresses: Vec<Url> = open.iter().filter_map(|path| files.uri(path)).collect();
        let job = Job {
            root: root.clone(),
            unsaved: files.unsaved(),
            addresses: checks::addresses(addresses.iter()),
            interrupt: interrupt.clone(),
        };
        if self.jobs.send(job).is_ok() {
            self.running = Some((root, interrupt));
        }
    }

    /// Lets a deck be checked after a pause; a running check of this deck is ended.
    fn plan(&mut self, root: PathBuf, pause: Duration) {
        if let Some((running, interrupt)) = &self.running
            && *running == root
        {
            interrupt.ask();
        }
        self.waiting.insert(root, Instant::now() + pause);
    }

    /// Lets all decks be checked that have open files.
    fn plan_all(&mut self) {
        let open = self.workspace.files.open_paths();
        let roots = open.iter().map(|path| self.workspace.root_of(path));
        let roots: BTreeSet<PathBuf> = roots.collect();
        for root in roots {
            self.plan(root, Duration::ZERO);
        }
    }

    /// Sends the diagnostics of a deck to the editor, and removes the diagnostics of files that the deck no longer has.
    fn show(&mut self, outcome: Outcome) {
        let Some(found) = outcome.found else { return };
        let old = self.shown.insert(outcome.root.clone(), found);
        let old = old.unwrap_or_default().into_keys();
        let new = self.shown.get(&outcome.root).into_iter().flatten();
        let paths: BTreeSet<PathBuf> = old.chain(new.map(|(path, _)| path.clone())).collect();
        paths.iter().for_each(|path| self.publish(path));
    }

    /// Sends the diagnostics of a file to the editor, from all decks that contain the file.
    fn publish(&self, path: &Path) {
        let Some(uri) = self.workspace.files.uri(path) else {
            return;
        };
        let mut all: Vec<Diagnostic> = Vec::new();
        for one in self.shown_of(path) {
            if !all.contains(one) {
                all.push(one.clone());
            }
        }
        let params = PublishDiagnosticsParams::new(uri, all, None);
        let method = notification::PublishDiagnostics::METHOD.to_owned();
        self.send(Message::Notification(Notification::new(method, params)));
    }

    fn shown_of(&self, path: &Path) -> impl Iterator<Item = &Diagnostic> {
        let of_decks = self.shown.values().filter_map(move |files| files.get(path));
        of_decks.flatten()
    }

    fn notice(&mut self, one: Notification) {
        match one.method.as_str() {
            notification::DidOpenTextDocument::METHOD => {
                if let Some(params) = params::<notification::DidOpenTextDocument>(one) {
                    let document = params.text_document;
                    let path = self.workspace.open(&document.uri, &document.text);
                    let root = self.workspace.root_of(&path);
                    if root != path {
                        self.forget(&path);
                    }
                    self.plan(root, Duration::ZERO);
                }
            }
            notification::DidChangeTextDocument::METHOD => {
                if let Some(params) = params::<notification::DidChangeTextDocument>(one) {
                    let path = path_of(&params.text_document.uri);
                    if let Some(document) = self.workspace.files.changing(&path) {
                        for change in params.content_changes {
                            document.change(change.range, &change.text);
                        }
                        let root = self.workspace.root_of(&path);
                        self.plan(root, PAUSE);
                    }
                }
            }
            notification::DidCloseTextDocument::METHOD => {
                if let Some(params) = params::<notification::DidCloseTextDocument>(one) {
                    let path = path_of(&params.text_document.uri);
                    self.workspace.close(&path);
                    self.waiting.remove(&path);
                    self.forget(&path);
                    self.plan_all();
                }
            }
            notification::DidSaveTextDocument::METHOD
            | notification::DidChangeWatchedFiles::METHOD => {
                self.workspace.files.forget_changed();
                self.plan_all();
            }
            _ => {}
        }
    }

    /// Removes the diagnostics of a deck from the editor.
    fn forget(&mut self, root: &Path) {
        let old = self.shown.remove(root).unwrap_or_default();
        old.keys().for_each(|path| self.publish(path));
    }

    fn answer(&mut self, request: Request) -> Response {
        match request.method.as_str() {
            request::Completion::METHOD => with::<request::Completion>(request, |params| {
                let place = self.place(&params.text_document_position);
                let items = place.map(|place| completion(&self.workspace, &place));
                Ok(Some(items.unwrap_or_default().into()))
            }),
            request::ResolveCompletionItem::METHOD => {
                with::<request::ResolveCompletionItem>(request, |item| Ok(with_documentation(item)))
            }
            request::HoverRequest::METHOD => with::<request::HoverRequest>(request, |params| {
                Ok(self.hover(&params.text_document_position_params))
            }),
            request::GotoDefinition::METHOD => with::<request::GotoDefinition>(request, |params| {
                let place = self.place(&params.text_document_position_params);
                let found = place.map(|place| definitions(&self.workspace, &place));
                Ok(found.map(GotoDefinitionResponse::Array))
            }),
            request::References::METHOD => with::<request::References>(request, |params| {
                let with_definitions = params.context.include_declaration;
                let place = self.place(&params.text_document_position);
                Ok(place.map(|place| references(&self.workspace, &place, with_definitions)))
            }),
            request::DocumentSymbolRequest::METHOD => {
                with::<request::DocumentSymbolRequest>(request, |params| {
                    let place = self.place(&TextDocumentPositionParams {
                        text_document: params.text_document,
                        position: Position::default(),
                    });
                    let entries = place.and_then(|place| {
                        let document = self.workspace.document(&place.view, place.file)?;
                        Some(outline(&place.view.cards, place.file, document))
                    });
                    Ok(entries.map(Into::into))
                })
            }
            request::PrepareRenameRequest::METHOD => {
                with::<request::PrepareRenameRequest>(request, |params| {
                    let place = self.place(&params);
                    let range = place.and_then(|place| changeable(&self.workspace, &place));
                    Ok(range.map(PrepareRenameResponse::Range))
                })
            }
            request::Rename::METHOD => with::<request::Rename>(request, |params| {
                let place = self.place(&params.text_document_position);
                let place = place.ok_or("the file is not open")?;
                rename(&self.workspace, &place, &params.new_name).map(Some)
            }),
            request::CodeActionRequest::METHOD => {
                with::<request::CodeActionRequest>(request, |params| Ok(Some(self.fixes(&params))))
            }
            method => {
                let message = format!("no such request: {method}");
                Response::new_err(request.id, ErrorCode::MethodNotFound as i32, message)
            }
        }
    }

    fn place(&mut self, at: &TextDocumentPositionParams) -> Option<Place> {
        let path = path_of(&at.text_document.uri);
        self.workspace.place(&path, at.position)
    }

    /// Explanations of a place: its keyword, parameter or name, and the codes of its diagnostics.
    fn hover(&mut self, at: &TextDocumentPositionParams) -> Option<Hover> {
        let place = self.place(at);
        let found = place.and_then(|place| hover(&self.workspace, &place));
        let path = path_of(&at.text_document.uri);
        let here = self
            .shown_of(&path)
            .filter(|one| one.range.start <= at.position && at.position <= one.range.end);
        let codes: BTreeSet<&str> = here
            .filter_map(|one| match &one.code {
                Some(NumberOrString::String(code)) => Some(code.as_str()),
                _ => None,
            })
            .collect();
        let codes = Code::ALL.iter().filter(|code| codes.contains(code.id()));
        let texts = codes.map(|code| (self.program.explain)(*code));
        let range = found.as_ref().map(|(_, range)| *range);
        let texts: Vec<String> = found
            .into_iter()
            .map(|(text, _)| text)
            .chain(texts)
            .collect();
        (!texts.is_empty()).then(|| Hover {
            contents: HoverContents::Markup(MarkupContent {
                kind: MarkupKind::PlainText,
                value: texts.join("\n\n"),
            }),
            range,
        })
    }

    /// Quick fixes: words that were probably meant replace the texts of diagnostics.
    fn fixes(&self, params: &CodeActionParams) -> Vec<CodeActionOrCommand> {
        let uri = &params.text_document.uri;
        let path = path_of(uri);
        let Some(file) = self.workspace.files.get(&path) else {
            return Vec::new();
        };
        let fix = |diagnostic: &Diagnostic| {
            let fix: Fix = serde_json::from_value(diagnostic.data.clone()?).ok()?;
            let (start, end) = (diagnostic.range.start, diagnostic.range.end);
            let line = file.document.line(start.line as usize);
            let [from, to] = [start, end].map(|position| file.document.column(position));
            let typed: String = line
                .chars()
                .skip(from)
                .take(to.checked_sub(from)?)
                .collect();
            // the text may have changed since it was checked, or hold the name of a parameter
            if typed != fix.found || typed.contains('<') || start.line != end.line {
                return None;
            }
            // of `NSTE=ALL` the word before the equality sign is wrong
            let wrong = match fix.meant.contains('=') {
                true => typed.as_str(),
                false => typed.split('=').next()?.trim_end(),
            };
            let end = file
                .document
                .position(start.line as usize, from + wrong.chars().count());
            let edit = TextEdit::new(Range { start, end }, fix.meant.clone());
            Some(CodeActionOrCommand::CodeAction(CodeAction {
                title: format!("Write {}", fix.meant),
                kind: Some(CodeActionKind::QUICKFIX),
                diagnostics: Some(vec![diagnostic.clone()]),
                edit: Some(WorkspaceEdit::new(HashMap::from([(
                    uri.clone(),
                    vec![edit],
                )]))),
                is_preferred: Some(true),
                ..CodeAction::default()
            }))
        };
        params.context.diagnostics.iter().filter_map(fix).collect()
    }
}

/// The parameters of a notification; `None` if they do not have the expected form.
fn params<N: notification::Notification>(one: Notification) -> Option<N::Params>
where
    N::Params: DeserializeOwned,
{
    one.extract(N::METHOD).ok()
}

/// The answer to a request.
fn with<R: request::Request>(
    request: Request,
    answer: impl FnOnce(R::Params) -> Result<R::Result, String>,
) -> Response
where
    R::Params: DeserializeOwned,
    R::Result: Serialize,
{
    let id = request.id.clone();
    let params = match request.extract::<R::Params>(R::METHOD) {
        Ok((_, params)) => params,
        Err(error) => {
            let code = ErrorCode::InvalidParams as i32;
            return Response::new_err(id, code, error.to_string());
        }
    };
    match answer(params) {
        Ok(result) => match serde_json::to_value(result) {
            Ok(value) => Response::new_ok(id, value),
            Err(error) => Response::new_err(id, ErrorCode::InternalError as i32, error.to_string()),
        },
        Err(why) => Response::new_err(id, ErrorCode::RequestFailed as i32, why),
    }
}
