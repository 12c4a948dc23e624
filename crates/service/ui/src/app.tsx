/** The page. */
export function App() {
  return <h1>reentry</h1>;
}
