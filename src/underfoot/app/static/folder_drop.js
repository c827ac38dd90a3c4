// A place that takes a folder (or files) by drop or choice and sends it, with the folders below. NiceGUI element.
export default {
  template: `
<div class="drop folder-drop" :class="{ over }" @dragover.prevent="over = true" @dragleave="over = false" @drop.prevent="dropped">
 <p>{{ words.drop }}</p>
 <p><button type="button" @click="$refs.folder.click()">{{ words.folder }}</button> <button type="button" @click="$refs.files.click()">{{ words.files }}</button></p>
 <input ref="folder" type="file" webkitdirectory hidden @change="chosen"><input ref="files" type="file" multiple hidden @change="chosen">
 <p class="soft" role="status">{{ state }}</p>
</div>`,
  props: { words: Object, address: String },
  data: () => ({ over: false, state: "" }),
  methods: {
    chosen(event) {
      this.send([...event.target.files].map((file) => ({ file, path: file.webkitRelativePath || file.name })));
      event.target.value = "";
    },
    async dropped(event) {
      this.over = false;
      const found = [], roots = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry()).filter(Boolean);
      for (const root of roots) await this.walk(root, found);
      this.send(found);
    },
    async walk(entry, found) {
      if (entry.isFile) {
        const file = await new Promise((done, failed) => entry.file(done, failed));
        found.push({ file, path: entry.fullPath.replace(/^\//, "") });
        return;
      }
      const reader = entry.createReader();
      for (;;) {  // a reader tells at most a hundred at a time
        const some = await new Promise((done, failed) => reader.readEntries(done, failed));
        if (!some.length) return;
        for (const each of some) await this.walk(each, found);
      }
    },
    async send(all) {
      const files = all.filter(({ path }) => !path.split("/").some((part) => part.startsWith("."))), refused = [];
      let sent = 0;
      for (const { file, path } of files) {
        this.state = `${sent + refused.length + 1} / ${files.length}: ${path}`;
        try {
          const place = path.split("/").map(encodeURIComponent).join("/");
          const response = await fetch(`${this.address}/${place}`, { method: "POST", body: file });
          const answer = response.ok ? await response.json() : { problem: (await response.text()).replace(/<[^>]*>/g, " ") };
          if (answer.problem) refused.push(`${path}: ${answer.problem}`); else sent += 1;
        } catch (problem) { refused.push(`${path}: ${problem.message}`); }
      }
      this.state = "";
      if (files.length) this.$emit("arrived", { sent, refused });
    },
  },
};
