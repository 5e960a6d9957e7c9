// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Sends the words of a frame: those before the field, as sptfra_records has them, and with FIELD the field: of one
// body as the core has answered it, of several the sums, in float32.
//
// From start to the first word: 10 cycles; then a word a cycle, where none waits.

`default_nettype none

module sptfra_contacts_output #(
    // Taxels
    parameter TAXELS = 100,
    // Records of bodies
    parameter CONTACTS = 4,
    // 1: the forces of all taxels go out, too; 0: the words before them alone
    parameter FIELD = 1,
    // Answers that have a place
    parameter BANKS = 4,
    // Prefix of the ROM file names, for instance a directory with its slash
    parameter ROM_DIR = "",
    // See sptfra_records
    parameter [31:0] MIDDLE_X = 32'h3c1374bc,
    parameter [31:0] MIDDLE_Y = 32'h3c1374bc,
    parameter [31:0] CHANGE_SQUARED = 32'h3fc80000,
    parameter [31:0] NEARNESS = 32'h47742400,
    parameter [31:0] LIMIT = 32'h3d75c28f,
    parameter [31:0] SLIPS_FROM = 32'd0,
    parameter [31:0] SLIPS_STILL = 32'd0,
    parameter integer PROGRAM_LENGTH = 128,
    parameter RECORDS_FILE = "",
    parameter [16*(CONTACTS+1)-1:0] LATENCIES = {(16 * (CONTACTS + 1)){1'b0}},
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 8) ? $clog2(TAXELS) : 3,
    parameter BANK_WIDTH = $clog2(BANKS),
    parameter FIELD_WIDTH = $clog2(3 * TAXELS)
) (
    input  wire clock,
    input  wire reset,
    // Frames that come, for their time
    input  wire in_taken,
    input  wire in_last,
    // Words before the field, and what is made of them: see sptfra_records
    input  wire header_write,
    input  wire [3:0] header_body,
    input  wire header_before,
    input  wire [3:0] header_index,
    input  wire [31:0] header_word,
    input  wire record_start,
    input  wire [3:0] kept,
    input  wire [7:0] bodies,
    input  wire [16*CONTACTS-1:0] taxels,
    input  wire saturated,
    output wire record_done,
    // A frame whose words are made, while idle: what follows is taken with start
    input  wire start,
    output wire idle,
    input  wire several,
    input  wire signed [9:0] unit, // power of two of a step of the sums
    input  wire [BANK_WIDTH-1:0] bank,
    output wire done, // one cycle, with the last word
    // What is read, each 1 cycle
    output wire advance,
    output wire [BANK_WIDTH+FIELD_WIDTH-1:0] field_address,
    input  wire [31:0] field_word,
    output wire [TAXEL_WIDTH-1:0] taxel,
    output wire reads_forces, // the sums are looked at
    input  wire [80:0] forces,
    // Words out
    output wire [31:0] m_tdata,
    output wire m_tlast,
    output wire m_tvalid,
    input  wire m_tready
);

    localparam [31:0] LAST_WORD = 16 + 8 * CONTACTS - 1;
    localparam [31:0] LAST_PLACE = 3 * TAXELS - 1;
    localparam WORD_WIDTH = $clog2(16 + 8 * CONTACTS);
    localparam ONE = 1;
    localparam TO_FLOAT = 7;

    wire words_bank;
    wire [WORD_WIDTH:0] words_address;
    wire [31:0] words_word;
    wire [31:0] timestamp;

    sptfra_records #(
        .CONTACTS       (CONTACTS),
        .MIDDLE_X       (MIDDLE_X),
        .MIDDLE_Y       (MIDDLE_Y),
        .CHANGE_SQUARED (CHANGE_SQUARED),
        .NEARNESS       (NEARNESS),
        .LIMIT          (LIMIT),
        .SLIPS_FROM     (SLIPS_FROM),
        .SLIPS_STILL    (SLIPS_STILL),
        .PROGRAM_LENGTH (PROGRAM_LENGTH),
        .ROM_DIR        (ROM_DIR),
        .FILE           (RECORDS_FILE),
        .LATENCIES      (LATENCIES)
    ) records (
        .clock       (clock),
        .reset       (reset),
        .in_write    (header_write),
        .in_body     (header_body),
        .in_before   (header_before),
        .in_word     (header_index),
        .in_data     (header_word),
        .start       (record_start),
        .kept        (kept),
        .bodies      (bodies),
        .taxels      (taxels),
        .saturated   (saturated),
        .done        (record_done),
        .out_bank    (words_bank),
        .out_address (words_address),
        .out_word    (words_word)
    );

    sptfra_timestamp timestamps (
        .clock     (clock),
        .reset     (reset),
        .in_taken  (in_taken),
        .in_last   (in_last),
        .timestamp (timestamp),
        .take      (done)
    );

    reg busy; // words are asked for or on their way
    reg is_several;
    reg signed [9:0] step_unit;
    reg [BANK_WIDTH-1:0] field_bank;
    reg of_bank;
    reg [15:0] number; // of the frame

    assign idle = !busy;
    assign advance = m_tready || !m_tvalid;
    assign reads_forces = (FIELD != 0) && busy && is_several;

    // ---- Stage 0: which word
    reg asks;
    reg is_field;
    reg [WORD_WIDTH-1:0] word;
    reg [FIELD_WIDTH-1:0] place;
    reg [1:0] component;
    reg [TAXEL_WIDTH-1:0] place_taxel;
    wire last_word = (word == LAST_WORD[WORD_WIDTH-1:0]);
    wire last_place = (place == LAST_PLACE[FIELD_WIDTH-1:0]);

    assign taxel = place_taxel;
    assign field_address = {field_bank, place};

    always @(posedge clock) begin
        if (asks && advance) begin
            word <= word + ONE[WORD_WIDTH-1:0];
            if (last_word) begin
                is_field <= (FIELD != 0);
                asks <= (FIELD != 0);
            end
            if (is_field) begin
                place <= place + ONE[FIELD_WIDTH-1:0];
                component <= (component == 2'd2) ? 2'd0 : component + 2'd1;
                if (component == 2'd2) begin
                    place_taxel <= place_taxel + 1'b1;
                end
                asks <= !last_place;
            end
        end
        if (done) begin
            busy <= 1'b0;
            number <= number + 16'd1;
        end
        if (start) begin
            busy <= 1'b1;
            asks <= 1'b1;
            is_several <= several;
            step_unit <= unit;
            field_bank <= bank;
            of_bank <= words_bank;
            is_field <= 1'b0;
            word <= {WORD_WIDTH{1'b0}};
            place <= {FIELD_WIDTH{1'b0}};
            component <= 2'd0;
            place_taxel <= {TAXEL_WIDTH{1'b0}};
        end
        if (reset) begin
            busy <= 1'b0;
            asks <= 1'b0;
            number <= 16'd0;
        end
    end

    // ---- Stage 1: the words there; those before the field are asked for again while they wait
    reg valid_1, last_1, is_field_1;
    reg [1:0] component_1;
    reg [WORD_WIDTH-1:0] word_1;

    assign words_address = {of_bank, advance ? word : word_1};

    always @(posedge clock) begin
        if (advance) begin
            valid_1 <= asks;
            last_1 <= (FIELD != 0) ? is_field && last_place : last_word;
            is_field_1 <= is_field;
            component_1 <= component;
            word_1 <= word;
        end
        if (reset) begin
            valid_1 <= 1'b0;
        end
    end

    // ---- Stage 2: the word as it is, or the force that becomes one
    reg valid_2, last_2, converts_2;
    reg [31:0] raw_2;
    reg signed [26:0] force_2;

    always @(posedge clock) begin
        if (advance) begin
            valid_2 <= valid_1;
            last_2 <= last_1;
            converts_2 <= is_field_1 && is_several;
            raw_2 <= is_field_1 ? field_word : words_word;
            if (!is_field_1 && (word_1 == {WORD_WIDTH{1'b0}})) begin
                raw_2[31:16] <= number;
            end
            if (!is_field_1 && (word_1 == ONE[WORD_WIDTH-1:0])) begin
                raw_2 <= timestamp;
            end
            force_2 <= (component_1 == 2'd0) ? forces[26:0] : (component_1 == 2'd1) ? forces[53:27] : forces[80:54];
        end
        if (reset) begin
            valid_2 <= 1'b0;
        end
    end

    // ---- Stage 9
    reg [TO_FLOAT:1] valids, lasts, converts;
    reg [31:0] raw_3, raw_4, raw_5, raw_6, raw_7, raw_8, raw_9;
    wire [31:0] converted;

    sptfra_fixed_to_float to_float (
        .clock      (clock),
        .enable     (advance),
        .fixed      ({{37{force_2[26]}}, force_2}),
        .exponent   (step_unit),
        .float_bits (converted)
    );

    always @(posedge clock) begin
        if (advance) begin
            valids <= {valids[TO_FLOAT-1:1], valid_2};
            lasts <= {lasts[TO_FLOAT-1:1], last_2};
            converts <= {converts[TO_FLOAT-1:1], converts_2};
            {raw_9, raw_8, raw_7, raw_6, raw_5, raw_4, raw_3} <= {raw_8, raw_7, raw_6, raw_5, raw_4, raw_3, raw_2};
        end
        if (reset) begin
            valids <= {TO_FLOAT{1'b0}};
        end
    end

    assign m_tvalid = valids[TO_FLOAT];
    assign m_tlast = lasts[TO_FLOAT];
    assign m_tdata = converts[TO_FLOAT] ? converted : raw_9;
    assign done = m_tvalid && m_tready && m_tlast;

endmodule

`default_nettype wire
