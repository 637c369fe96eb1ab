/* Stub of cJSON: what the patched lines read. */
#ifndef CJSON_H
#define CJSON_H

typedef struct {
    char *valuestring;
} cJSON;

cJSON *cJSON_GetObjectItem(const cJSON *object, const char *name);
int cJSON_IsString(const cJSON *item);

#endif
