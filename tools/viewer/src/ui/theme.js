// SPDX-License-Identifier: Apache-2.0
/** The system's theme until the user chooses another. */
export function follow_theme(store, wish) {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  let chosen = wish === 'dark' || wish === 'light' ? wish : null;
  const apply = () => {
    const theme = chosen ?? (dark.matches ? 'dark' : 'light');
    document.documentElement.dataset.theme = theme;
    store.set({theme});
  };
  dark.addEventListener('change', apply);
  apply();
  store.switch_theme = () => {
    chosen = store.state.theme === 'dark' ? 'light' : 'dark';
    apply();
  };
}
