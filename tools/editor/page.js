// A manifest in Monaco (the editor of VS Code), with completion, hover and faults from the schema as monaco-yaml gives them
// (the language server of the YAML extension).
import * as monaco from 'monaco-editor'
import { configureMonacoYaml } from 'monaco-yaml'

window.MonacoEnvironment = {
  getWorker: (_, label) => new Worker(label === 'yaml' ? 'yaml.worker.js' : 'editor.worker.js')
}
const text = await (await fetch('manifest.yaml')).text()
const schema = await (await fetch('schema.json')).json()
configureMonacoYaml(monaco, {
  schemas: [{ fileMatch: ['*'], uri: 'terrell.schema.json', schema }]
})
const model = monaco.editor.createModel(text, 'yaml', monaco.Uri.parse('file:///flyby.yaml'))
const editor = monaco.editor.create(document.getElementById('editor'), {
  model, fontSize: 14, lineNumbersMinChars: 3, minimap: { enabled: false }, scrollBeyondLastLine: false, theme: 'vs',
  quickSuggestions: false, hover: { delay: 10 }, automaticLayout: true, suggest: { showStatusBar: false }
})
editor.focus()
// The keys that a body may have.
const [line, column] = (new URLSearchParams(location.search).get('at') ?? '14,5').split(',').map(Number)
editor.setPosition({ lineNumber: line, column })
setTimeout(() => editor.trigger('', 'editor.action.triggerSuggest', {}), 4000)
setTimeout(() => editor.trigger('', 'toggleSuggestionDetails', {}), 8000)
