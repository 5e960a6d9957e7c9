// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Keeps the core's answers to frames as those of one body: the words before the field, the field, and once more the
// normal forces, which are looked at while a field goes out. Notes the largest exponent of a field's forces, and what
// presses most.
//
// Takes a word a cycle. The words of an answer are there from the cycle after its last on.

`default_nettype none

module sptfra_contacts_answers #(
    // Taxels
    parameter TAXELS = 100,
    // Answers that have a place: as many as frames
    parameter BANKS = 4,
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 8) ? $clog2(TAXELS) : 3,
    parameter BANK_WIDTH = $clog2(BANKS),
    parameter FIELD_WIDTH = $clog2(3 * TAXELS)
) (
    input  wire clock,
    input  wire reset,
    // Words of the core
    input  wire word_valid,
    input  wire [31:0] word,
    input  wire word_last,
    output wire [3:0] word_index, // of the words before the field
    output wire in_field,
    input  wire keeps, // it is an answer to a frame
    // The oldest answer: its place; the next one has its turn
    output wire there,
    input  wire next,
    output wire [BANK_WIDTH-1:0] oldest,
    output wire [7:0] exponent,
    output wire [31:0] largest, // float32, of what presses; 0 if nothing does
    // Words, each 1 cycle
    input  wire [3:0] header_address, // of the oldest
    output wire [31:0] header_word,
    input  wire [TAXEL_WIDTH-1:0] normal_address, // of the oldest
    output wire [31:0] normal_word,
    input  wire field_enable,
    input  wire [BANK_WIDTH+FIELD_WIDTH-1:0] field_address,
    output wire [31:0] field_word
);

    localparam ONE = 1;

    // ---- Which word it is
    reg is_field;
    reg [3:0] index;
    reg [FIELD_WIDTH-1:0] place;
    reg [1:0] component;
    reg [TAXEL_WIDTH-1:0] taxel;
    reg [BANK_WIDTH-1:0] newest;
    wire kept = word_valid && keeps;

    assign word_index = index;
    assign in_field = is_field;

    always @(posedge clock) begin
        if (word_valid) begin
            index <= index + 4'd1;
            if (index == 4'd15) begin
                is_field <= 1'b1;
            end
            if (is_field) begin
                place <= place + ONE[FIELD_WIDTH-1:0];
                component <= (component == 2'd2) ? 2'd0 : component + 2'd1;
                if (component == 2'd2) begin
                    taxel <= taxel + 1'b1;
                end
            end
        end
        if (reset || (word_valid && word_last)) begin
            is_field <= 1'b0;
            index <= 4'd0;
            place <= {FIELD_WIDTH{1'b0}};
            component <= 2'd0;
            taxel <= {TAXEL_WIDTH{1'b0}};
        end
    end

    // ---- What is to be known of a field
    reg [7:0] most; // the largest exponent
    reg [30:0] presses; // the largest magnitude of a negative normal force
    reg [38:0] facts [0:BANKS-1];
    wire [7:0] next_most = (is_field && (word[30:23] > most)) ? word[30:23] : most;
    wire is_larger = is_field && (component == 2'd2) && word[31] && (word[30:0] > presses);
    wire [30:0] next_presses = is_larger ? word[30:0] : presses;

    always @(posedge clock) begin
        if (word_valid) begin
            most <= word_last ? 8'd0 : next_most;
            presses <= word_last ? 31'd0 : next_presses;
        end
        if (kept && word_last) begin
            facts[newest] <= {next_most, next_presses};
            newest <= newest + 1'b1;
        end
        if (reset) begin
            most <= 8'd0;
            presses <= 31'd0;
            newest <= {BANK_WIDTH{1'b0}};
        end
    end

    // ---- Answers that are there
    reg [BANK_WIDTH-1:0] turn;
    reg [BANK_WIDTH:0] waiting;

    assign there = (waiting != {(BANK_WIDTH+1){1'b0}});
    assign oldest = turn;
    assign exponent = facts[turn][38:31];
    assign largest = {1'b1, facts[turn][30:0]};

    always @(posedge clock) begin
        waiting <= waiting + {{BANK_WIDTH{1'b0}}, kept && word_last} - {{BANK_WIDTH{1'b0}}, next};
        if (next) begin
            turn <= turn + 1'b1;
        end
        if (reset) begin
            turn <= {BANK_WIDTH{1'b0}};
            waiting <= {(BANK_WIDTH+1){1'b0}};
        end
    end

    // ---- Memories
    sptfra_ram #(
        .WIDTH         (32),
        .DEPTH         (BANKS << 4),
        .ADDRESS_WIDTH (BANK_WIDTH + 4)
    ) headers (
        .clock         (clock),
        .write_enable  (kept && !is_field),
        .write_address ({newest, index}),
        .write_data    (word),
        .read_enable   (there),
        .read_address  ({turn, header_address}),
        .read_data     (header_word)
    );

    sptfra_ram #(
        .WIDTH         (32),
        .DEPTH         (BANKS << TAXEL_WIDTH),
        .ADDRESS_WIDTH (BANK_WIDTH + TAXEL_WIDTH)
    ) normals (
        .clock         (clock),
        .write_enable  (kept && is_field && (component == 2'd2)),
        .write_address ({newest, taxel}),
        .write_data    (word),
        .read_enable   (there),
        .read_address  ({turn, normal_address}),
        .read_data     (normal_word)
    );

    sptfra_ram #(
        .WIDTH         (32),
        .DEPTH         (BANKS << FIELD_WIDTH),
        .ADDRESS_WIDTH (BANK_WIDTH + FIELD_WIDTH)
    ) fields (
        .clock         (clock),
        .write_enable  (kept && is_field),
        .write_address ({newest, place}),
        .write_data    (word),
        .read_enable   (field_enable),
        .read_address  (field_address),
        .read_data     (field_word)
    );

endmodule

`default_nettype wire
